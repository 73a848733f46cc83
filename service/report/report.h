// One HTML file that a scientist can read, print and archive: figures as inline SVG and PNG, no
// script, no font, no address outside the file.
//
// Domain values in, text out. The same input gives the same bytes: no time, path or host is added.
#ifndef EYEBOX_SERVICE_REPORT_REPORT_H_
#define EYEBOX_SERVICE_REPORT_REPORT_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"

namespace eyebox::service::report {

struct Fact {
  std::string label;
  std::string value;
};

// A figure that stands at the top in large type, for example {"gamma", "2.301 ± 0.004", "0.17 %"}.
struct KeyResult {
  std::string label;
  std::string value;
  std::string note;
};

struct Range {
  double minimum = 0;
  double maximum = 0;
};

struct MapFigure {
  std::string title;     // "Uniformity g(x)"
  std::string caption;   // what the reader should see in it
  std::string quantity;  // on the colour bar: "g"
  std::string unit;      // "1" for a pure number
  ImageSize size;
  std::span<const float> values;  // [height, width], row 0 at the top; NaN is invalid
  std::optional<Range> range;     // of the colours; that of the valid values unless given
  // Contours of `contoured`, which is `values` unless given (a smooth model gives quieter lines).
  std::vector<double> contours;
  std::span<const float> contoured;  // [height, width] or empty
  // Field angle of each column (right positive) and of each row (up positive), strictly monotone;
  // both empty: the axes are in pixels.
  std::vector<double> column_deg;
  std::vector<double> row_deg;
};

struct FitLevel {
  double drive = 0;
  double luminance = 0;
  double luminance_sigma = 0;    // 0 where it is not known
  double relative_residual = 0;  // measured / fitted - 1
};

struct FitCurvePoint {
  double drive = 0;
  double luminance = 0;
};

struct FitFigure {
  std::string title;
  std::string caption;         // formula, weighting, leave-one-out error
  std::string luminance_unit;  // "cd/m2" or "relative"
  std::vector<FitLevel> levels;
  std::vector<FitCurvePoint> curve;  // ascending drive, dense enough to be joined by lines
};

struct CertificateRow {
  std::string table;   // "linearize.cube"
  std::string target;  // "hdrp, 32 knots"
  double max_relative = 0;
  double rms_relative = 0;
  double at_u = 0;
  Range u;  // where it holds, as a fraction of white
};

struct ErrorPoint {
  double u = 0;               // fraction of white, above 0
  double relative_error = 0;  // luminance shown / luminance wanted - 1
};

struct ErrorCurve {
  std::string label;
  std::vector<ErrorPoint> points;  // ascending u
};

struct ParameterRow {
  std::string name;
  double value = 0;
  double sigma = 0;  // 0: the value is exact, a setting or itself an uncertainty
  std::string unit;
  bool held = false;  // a parameter of the model that was not fitted
};

struct ParameterTable {
  std::string title;
  std::vector<ParameterRow> rows;
};

struct ReportInput {
  std::string title;
  std::string summary;  // a sentence or two; may be empty
  std::vector<KeyResult> key_results;
  std::vector<Fact> facts;  // rig, recording, version, ...
  std::vector<std::string> warnings;
  std::vector<MapFigure> maps;
  std::optional<FitFigure> fit;
  std::vector<CertificateRow> certificates;
  std::vector<ErrorCurve> error_curves;
  std::vector<ParameterTable> parameters;
  std::vector<std::string> history;  // steps in order
};

// Errors: InvalidArgument naming the figure (sizes that disagree, no valid value in a map, angles
// that are not monotone, a number that is not finite).
absl::StatusOr<std::string> RenderReport(const ReportInput& input);

// "2.301 ± 0.004": sigma to two significant digits, the value to the same place; without sigma
// where that is 0 ("held").
std::string WithSigma(double value, double sigma);
// "0.61 %", three significant digits.
std::string Percent(double fraction);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_REPORT_H_
