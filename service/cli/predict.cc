#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/scene_output.h"
#include "service/cli/terminal.h"
#include "service/predict_rows.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  RowPredictionRequest rows;
  std::string csv;
  std::string cube;
  std::string out;
  optics::Renderer pipeline = optics::Renderer::kHdrp;
  std::optional<fit::RowMaterial> material;
  std::string model = "measured";
  std::string scene;
  std::string activation;
  bool json = false;
};

const std::map<std::string, fit::RowMaterial> kMaterials = {
    {"unlit", fit::RowMaterial::kUnlit}, {"lambertian", fit::RowMaterial::kLambertian}};
const std::map<std::string, optics::Renderer> kPipelines = {
    {"hdrp", optics::Renderer::kHdrp},
    {"urp", optics::Renderer::kUrp},
    {"built_in_gamma", optics::Renderer::kBuiltInGamma},
    {"built_in_linear", optics::Renderer::kBuiltInLinear}};

void Print(const v1::RowPredictionResult& result) {
  std::printf("%d rows, %s, %s%s%s\n", result.rows(), result.pipeline().c_str(),
              result.material().c_str(),
              result.model().empty() ? "" : ", model: ", result.model().c_str());
  std::printf("  terms evaluated: %s\n", absl::StrJoin(result.terms(), ", ").c_str());
  std::printf("  stages after shading: %s\n", absl::StrJoin(result.stages(), ", ").c_str());
  PrintParameters(result.parameters());
  if (result.has_error()) {
    const v1::RenderError& error = result.error();
    std::printf("  against the rows' v, in 1/255: median %.3f, mean %.3f, bias %+.2f %+.2f %+.2f\n",
                error.median_levels(), error.mean_levels(), error.bias_levels(0),
                error.bias_levels(1), error.bias_levels(2));
    std::printf("  worst %.1f, in row %d\n", error.worst_levels(), error.worst_row());
  }
  std::printf("Wrote %s\n", result.file().c_str());
}

absl::Status Run(const Options& options) {
  if (!options.scene.empty()) return RunScene({options.scene, options.activation}, options.json);
  RowPredictionRequest request = options.rows;
  request.csv = options.csv;
  request.cube = options.cube;
  request.out = options.out;
  request.renderer = options.pipeline;
  request.activation = options.activation;
  request.material = *options.material;
  request.published = options.model == "published";
  EYEBOX_ASSIGN_OR_RETURN(const v1::RowPredictionResult result, PredictRows(request));
  PrintWarnings(result.warnings());
  if (options.json) return PrintJson(result);
  Print(result);
  return absl::OkStatus();
}

}  // namespace

void AddPredict(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "predict", "Predict what a scene asks the display to show.",
      "eyebox predict --csv rows.csv --pipeline hdrp --material lambertian --cube lut.cube "
      "--out predicted.csv\n"
      "  eyebox predict --scene scene.textproto --activation fit.json",
      [](CLI::App& command, Options& options) {
        auto* source = command.add_option_group("source", "Exactly one of");
        auto* csv = source->add_option(
            "--csv", options.csv,
            "Rows with m_r,m_g,m_b; for lambertian also e, n_x.., l_x.., i_d, d_r.., "
            "i_a, a_r..; v_r.. are compared where present");
        auto* scene = source->add_option("--scene", options.scene,
                                         "Materials, lights and patches (textproto)");
        source->require_option(1);
        command.add_option("--activation", options.activation,
                           "Of the display, to tell luminance or X, Y, Z: what `eyebox fit --json` "
                           "printed");
        auto* pipeline = command
                             .add_option("--pipeline", options.pipeline,
                                         "Unity's renderer that the rows are for (default: hdrp)")
                             ->transform(OneOf(kPipelines));
        csv->needs(command.add_option("--material", options.material, "unlit or lambertian")
                       ->transform(OneOf(kMaterials)));
        auto* cube = command.add_option("--cube", options.cube,
                                        "Table that colours pass (default: none): .cube of HDRP's "
                                        "External tonemapping, strip PNG "
                                        "of the other pipelines");
        csv->needs(command.add_option(
            "--out", options.out, "File to write: the rows with u_hat_r.. and v_hat_r.. appended"));
        auto* model = command
                          .add_option("--model", options.model,
                                      "measured (with buffers and grading table) or published")
                          ->check(CLI::IsMember({"measured", "published"}))
                          ->capture_default_str();
        auto* dither = command.add_option(
            "--dither-mean", options.rows.dither_mean_levels,
            "Mean of HDRP's dither at the pixel looked at, in 1/255 (default: as "
            "measured at one pixel; 0 for another)");
        // A scene file says these itself.
        for (auto* of_rows : {pipeline, cube, model, dither}) scene->excludes(of_rows);
        command.add_flag("--json", options.json, "Print the result as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
