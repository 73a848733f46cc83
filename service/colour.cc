#include "service/colour.h"

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/results/colour.h"

namespace eyebox::service {

absl::StatusOr<v1::ColourResult> FitColourCsv(const std::filesystem::path& file,
                                              const fit::ColourOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::ColourSeries series, fit::ReadColourSeriesCsv(file));
  EYEBOX_ASSIGN_OR_RETURN(const fit::ColourChoice choice, fit::ChooseColour(series, options));
  v1::ColourResult result = DescribeColour(choice);
  result.set_source(file.filename().string());
  return result;
}

bool IsColourFit(std::string_view json) {
  // Of all results only this one has the field, and every field is printed.
  return json.find("\"additivity\"") != std::string_view::npos;
}

absl::StatusOr<v1::ColourCubeResult> DesignColourCube(const ColourCubeRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::ColourModel model,
                          ColourModelOf(request.fit, request.fit_source));
  EYEBOX_ASSIGN_OR_RETURN(
      const fit::ColourTable table,
      fit::DesignColourTable(model, request.target, request.size, request.design));
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, fit::EncodeColourTable(table));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out, bytes));
  return DescribeColourCube(table, request.design.goal, request.fit,
                            request.out.filename().string(), bytes);
}

}  // namespace eyebox::service
