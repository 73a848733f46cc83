#include "service/predict_rows.h"

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/csv.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/cube/table_file.h"
#include "fit/renderer/compare_models.h"
#include "service/artifacts.h"
#include "service/results/parameter.h"
#include "service/results/renderer.h"

namespace eyebox::service {
namespace {

constexpr std::array<const char*, 6> kAdded = {"u_hat_r", "u_hat_g", "u_hat_b",
                                               "v_hat_r", "v_hat_g", "v_hat_b"};
constexpr size_t kLimitBytes = size_t{1} << 30;
constexpr int kUsualSize = 32;

void AppendField(std::string& text, std::string_view field) {
  if (field.find_first_of(",\"\r\n") == std::string_view::npos) {
    text += field;
    return;
  }
  text += '"';
  for (const char letter : field) {
    if (letter == '"') text += '"';
    text += letter;
  }
  text += '"';
}

absl::Status CheckColumns(const CsvTable& table) {
  for (const char* name : kAdded) {
    if (!table.FindColumn(name)) continue;
    return BadInput(absl::StrCat(table.File().string(), ":1, column ", name),
                    "these rows are predicted already", "give the rows without that column");
  }
  return absl::OkStatus();
}

std::string EncodeRows(const CsvTable& table, const std::vector<fit::RowPrediction>& predictions) {
  std::string text;
  const size_t columns = table.Header().size();
  for (const std::string_view name : table.Header()) {
    AppendField(text, name);
    text += ',';
  }
  for (size_t i = 0; i < kAdded.size(); ++i) {
    absl::StrAppend(&text, kAdded[i], i + 1 == kAdded.size() ? "\n" : ",");
  }
  for (size_t row = 0; row < table.RowCount(); ++row) {
    for (size_t column = 0; column < columns; ++column) {
      AppendField(text, table.Field(row, column));
      text += ',';
    }
    const optics::Rgb& u = predictions[row].unprocessed;
    const optics::Rgb& v = predictions[row].stored;
    absl::StrAppendFormat(&text, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", u[0], u[1], u[2], v[0], v[1],
                          v[2]);
  }
  return text;
}

// Rows that carry v show how well they were predicted.
void AddError(const RowPredictionRequest& request, const std::vector<fit::SceneRow>& rows,
              const std::vector<fit::RowPrediction>& predictions, v1::RowPredictionResult& result) {
  if (rows.empty() || !rows.front().stored) return;
  std::vector<optics::Rgb> predicted;
  for (const fit::RowPrediction& prediction : predictions) predicted.push_back(prediction.stored);
  const fit::RenderedSet set{request.csv.filename().string(), request.material, rows, {}};
  DescribeRenderError(fit::ErrorOf(set, predicted), *result.mutable_error());
}

fit::HdrpModel ModelOf(const RowPredictionRequest& request) {
  fit::HdrpModel model = request.published ? fit::HdrpModel::Published() : fit::HdrpModel();
  model.dither_mean_levels = request.dither_mean_levels.value_or(model.dither_mean_levels);
  return model;
}

void AddModel(const fit::HdrpModel& model, v1::RowPredictionResult& result) {
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "light_scale", model.light_scale, 0, "1");
  AddParameter(parameters, "reflectance_floor", model.reflectance_floor, 0, "1");
  AddParameter(parameters, "dither_mean", model.dither_mean_levels, 0, "1/255");
}

}  // namespace

absl::StatusOr<optics::ColourTable> ReadExternalTable(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(fit::Cube3d cube, fit::ReadCube(file));
  const std::array<double, 3> zeros = {0, 0, 0};
  const std::array<double, 3> ones = {1, 1, 1};
  if (cube.domain_min != zeros || cube.domain_max != ones) {
    return BadInput(file.string(), "its domain is not 0 to 1, which HDRP would pass over",
                    "give a .cube made for HDRP");
  }
  return optics::ColourTable{cube.size, std::move(cube.entries)};
}

absl::StatusOr<v1::RowPredictionResult> PredictRows(const RowPredictionRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(request.csv, kLimitBytes));
  EYEBOX_RETURN_IF_ERROR(CheckColumns(table));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::SceneRow> rows,
                          fit::SceneRowsOf(table, request.material));
  v1::RowPredictionResult result;
  std::optional<optics::ColourTable> cube;
  if (!request.cube.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(cube, ReadExternalTable(request.cube));
    if (cube->size != kUsualSize) {
      result.add_warnings(absl::StrFormat(
          "the project's grading LUT size must be %d like the cube's, or Unity misreads it",
          cube->size));
    }
  }
  const fit::HdrpModel model = ModelOf(request);
  EYEBOX_ASSIGN_OR_RETURN(const fit::HdrpRenderer renderer,
                          fit::HdrpRenderer::Create(model, cube ? &*cube : nullptr));
  std::vector<fit::RowPrediction> predictions;
  predictions.reserve(rows.size());
  for (const fit::SceneRow& row : rows) {
    predictions.push_back(renderer.Predict(row, request.material));
  }
  const std::string text = EncodeRows(table, predictions);
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out, text));
  AddModel(model, result);
  result.set_pipeline("hdrp");
  result.set_material(request.material == fit::RowMaterial::kUnlit ? "unlit" : "lambertian");
  result.set_model(request.published ? "published" : "measured");
  result.set_rows(static_cast<int>(rows.size()));
  AddAll(*result.mutable_terms(), renderer.Terms(rows, request.material));
  for (const optics::Stage& stage : renderer.Stages()) {
    result.add_stages(std::string(optics::NameOf(stage)));
  }
  result.set_file(request.out.string());
  result.set_sha256(Sha256(text));
  AddError(request, rows, predictions, result);
  return result;
}

}  // namespace eyebox::service
