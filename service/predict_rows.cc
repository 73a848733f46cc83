#include "service/predict_rows.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/csv.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/renderer/compare_models.h"
#include "service/artifacts.h"
#include "service/display.h"
#include "service/results/parameter.h"
#include "service/results/renderer.h"
#include "service/scene/render_rows.h"

namespace eyebox::service {
namespace {

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

std::vector<std::string> AddedColumns(const std::optional<Display>& display) {
  std::vector<std::string> names = {"u_hat_r", "u_hat_g", "u_hat_b",
                                    "v_hat_r", "v_hat_g", "v_hat_b"};
  if (!display) return names;
  for (const std::string& quantity : display->Quantities()) {
    names.push_back(quantity + "_hat");
    names.push_back(quantity + "_hat_sigma");
  }
  return names;
}

absl::Status CheckColumns(const CsvTable& table, const std::vector<std::string>& added) {
  for (const std::string& name : added) {
    if (!table.FindColumn(name)) continue;
    return BadInput(absl::StrCat(table.File().string(), ":1, column ", name),
                    "these rows are predicted already", "give the rows without that column");
  }
  return absl::OkStatus();
}

// What was appended to the fields of each row, and how many have no luminance.
struct Answers {
  std::vector<std::string> fields;  // [rows], begins with a comma; empty without a display
  int without = 0;
};

Answers Answer(const std::optional<Display>& display,
               const std::vector<fit::RowPrediction>& predictions) {
  Answers answers;
  answers.fields.resize(predictions.size());
  if (!display) return answers;
  const std::string empty(2 * display->Quantities().size(), ',');
  for (size_t row = 0; row < predictions.size(); ++row) {
    const std::vector<v1::Parameter> answer = display->Answer(predictions[row].stored);
    for (const v1::Parameter& quantity : answer) {
      absl::StrAppendFormat(&answers.fields[row], ",%.9g,%.3g", quantity.value(), quantity.sigma());
    }
    if (!answer.empty()) continue;
    answers.fields[row] = empty;
    ++answers.without;
  }
  return answers;
}

std::string EncodeRows(const CsvTable& table, const std::vector<std::string>& added,
                       const std::vector<fit::RowPrediction>& predictions, const Answers& answers) {
  std::string text;
  const size_t columns = table.Header().size();
  for (const std::string_view name : table.Header()) {
    AppendField(text, name);
    text += ',';
  }
  absl::StrAppend(&text, absl::StrJoin(added, ","), "\n");
  for (size_t row = 0; row < table.RowCount(); ++row) {
    for (size_t column = 0; column < columns; ++column) {
      AppendField(text, table.Field(row, column));
      text += ',';
    }
    const optics::Rgb& u = predictions[row].unprocessed;
    const optics::Rgb& v = predictions[row].stored;
    absl::StrAppendFormat(&text, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g%s\n", u[0], u[1], u[2], v[0], v[1],
                          v[2], answers.fields[row]);
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

absl::StatusOr<RowRenderer> RendererOf(const RowPredictionRequest& request) {
  RowRenderer with{request.renderer, {}, request.cube};
  if (request.renderer == optics::Renderer::kHdrp) {
    if (request.published) with.model = fit::HdrpModel::Published();
    with.model.dither_mean_levels =
        request.dither_mean_levels.value_or(with.model.dither_mean_levels);
    return with;
  }
  if (request.published || request.dither_mean_levels) {
    return BadInput(request.published ? "--model" : "--dither-mean", "is a setting of HDRP",
                    "leave it out or choose --pipeline hdrp");
  }
  return with;
}

void Describe(const RowPredictionRequest& request, const RowRenderer& with,
              const RowRendering& rendering, v1::RowPredictionResult& result) {
  result.set_pipeline(std::string(optics::NameOf(request.renderer)));
  result.set_material(request.material == fit::RowMaterial::kUnlit ? "unlit" : "lambertian");
  result.set_rows(static_cast<int>(rendering.predictions.size()));
  AddAll(*result.mutable_terms(), rendering.terms);
  AddAll(*result.mutable_stages(), rendering.stages);
  if (request.renderer != optics::Renderer::kHdrp) return;
  result.set_model(request.published ? "published" : "measured");
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "light_scale", with.model.light_scale, 0, "1");
  AddParameter(parameters, "reflectance_floor", with.model.reflectance_floor, 0, "1");
  AddParameter(parameters, "dither_mean", with.model.dither_mean_levels, 0, "1/255");
  if (rendering.table_size != 0 && rendering.table_size != kUsualSize) {
    result.add_warnings(absl::StrFormat(
        "the project's grading LUT size must be %d like the cube's, or Unity misreads it",
        rendering.table_size));
  }
}

void DescribeAnswers(const RowPredictionRequest& request, int without,
                     v1::RowPredictionResult& result) {
  if (request.activation.empty()) return;
  result.set_activation_source(request.activation.string());
  result.set_rows_without_luminance(without);
  result.add_warnings(
      "the sigma of a luminance is that of the display's fit; what the renderer model leaves, "
      "about "
      "half a level of 255, is not in it");
  if (without == 0) return;
  result.add_warnings(absl::StrCat(
      without, " rows have a coloured drive and no luminance: the display was measured in grey"));
}

}  // namespace

absl::StatusOr<v1::RowPredictionResult> PredictRows(const RowPredictionRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const RowRenderer with, RendererOf(request));
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(request.csv, kLimitBytes));
  std::optional<Display> display;
  if (!request.activation.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(display, Display::Read(request.activation));
  }
  const std::vector<std::string> added = AddedColumns(display);
  EYEBOX_RETURN_IF_ERROR(CheckColumns(table, added));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::SceneRow> rows,
                          fit::SceneRowsOf(table, request.material));
  EYEBOX_ASSIGN_OR_RETURN(const RowRendering rendering,
                          RenderRows(rows, request.material, with, request.csv));
  const Answers answers = Answer(display, rendering.predictions);
  const std::string text = EncodeRows(table, added, rendering.predictions, answers);
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out, text));
  v1::RowPredictionResult result;
  Describe(request, with, rendering, result);
  DescribeAnswers(request, answers.without, result);
  result.set_file(request.out.string());
  result.set_sha256(Sha256(text));
  AddError(request, rows, rendering.predictions, result);
  return result;
}

}  // namespace eyebox::service
