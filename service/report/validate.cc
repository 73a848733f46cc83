#include "service/report/validate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "capture/base/status.h"
#include "service/report/raster.h"

namespace eyebox::service::report {
namespace {

bool AllFinite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

absl::Status Complain(const std::string& figure, const std::string& what) {
  return BadInput("report, " + figure, what, "pass what the figure's declaration asks for");
}

bool AnglesServe(const std::vector<double>& angles_deg, int pixels) {
  const auto begin = angles_deg.begin();
  const auto end = angles_deg.end();
  return angles_deg.size() == static_cast<size_t>(pixels) && pixels >= 2 &&
         std::all_of(begin, end, [](double angle) { return std::isfinite(angle); }) &&
         (std::adjacent_find(begin, end, std::less_equal<>()) == end ||
          std::adjacent_find(begin, end, std::greater_equal<>()) == end);
}

absl::Status ValidateMap(const MapFigure& map) {
  if (map.size.width_px < 1 || map.size.height_px < 1 ||
      map.values.size() != map.size.PixelCount()) {
    return Complain(map.title, "the values do not fill width x height");
  }
  if (!map.contoured.empty() && map.contoured.size() != map.values.size()) {
    return Complain(map.title, "the contoured map has another size");
  }
  if (std::any_of(map.values.begin(), map.values.end(), [](float v) { return std::isinf(v); })) {
    return Complain(map.title, "a value is infinite");
  }
  if (!RangeOf(map.values)) return Complain(map.title, "no value is valid");
  if (map.range && !(map.range->minimum < map.range->maximum)) {
    return Complain(map.title, "the range is empty");
  }
  if (map.column_deg.empty() && map.row_deg.empty()) return absl::OkStatus();
  if (!AnglesServe(map.column_deg, map.size.width_px) ||
      !AnglesServe(map.row_deg, map.size.height_px)) {
    return Complain(map.title, "the field angles are not one per column and row, monotone");
  }
  return absl::OkStatus();
}

absl::Status ValidateFit(const FitFigure& fit) {
  if (fit.levels.empty()) return Complain(fit.title, "no level is given");
  for (const FitLevel& level : fit.levels) {
    if (!AllFinite(
            {level.drive, level.luminance, level.luminance_sigma, level.relative_residual}) ||
        level.luminance_sigma < 0) {
      return Complain(fit.title, "a level is not finite or its sigma is negative");
    }
  }
  for (const FitCurvePoint& point : fit.curve) {
    if (!AllFinite({point.drive, point.luminance})) {
      return Complain(fit.title, "the curve is not finite");
    }
  }
  return absl::OkStatus();
}

absl::Status ValidateCertificates(const ReportInput& input) {
  for (const CertificateRow& row : input.certificates) {
    if (!AllFinite({row.max_relative, row.rms_relative, row.at_u, row.u.minimum, row.u.maximum}) ||
        row.u.minimum <= 0 || row.u.minimum >= row.u.maximum) {
      return Complain(row.table, "the certificate is not finite or its range is empty");
    }
  }
  for (const ErrorCurve& curve : input.error_curves) {
    if (curve.points.size() < 2) return Complain(curve.label, "the curve has no two points");
    double below = 0;
    for (const ErrorPoint& point : curve.points) {
      if (!AllFinite({point.u, point.relative_error}) || point.u <= below) {
        return Complain(curve.label, "u does not rise from above 0, or an error is not finite");
      }
      below = point.u;
    }
  }
  return absl::OkStatus();
}

absl::Status ValidateParameters(const ParameterTable& table) {
  for (const ParameterRow& row : table.rows) {
    if (!AllFinite({row.value, row.sigma}) || row.sigma < 0) {
      return Complain(row.name, "the value is not finite or its sigma is negative");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status Validate(const ReportInput& input) {
  for (const MapFigure& map : input.maps) EYEBOX_RETURN_IF_ERROR(ValidateMap(map));
  if (input.fit) EYEBOX_RETURN_IF_ERROR(ValidateFit(*input.fit));
  EYEBOX_RETURN_IF_ERROR(ValidateCertificates(input));
  for (const ParameterTable& table : input.parameters) {
    EYEBOX_RETURN_IF_ERROR(ValidateParameters(table));
  }
  return absl::OkStatus();
}

}  // namespace eyebox::service::report
