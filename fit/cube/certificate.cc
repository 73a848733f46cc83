#include "fit/cube/certificate.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fit/cube/goal.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

double ErrorAt(const TableDesign& table, const Activation& activation, double x) {
  return RelativeError(activation, DriveThroughTable(table, x * table.white_u), x);
}

double LargestStepAt8Bits(const Activation& activation, double x_from) {
  const double from = WantedLuminance(activation, x_from);
  double largest = 0;
  for (int drive = 255; drive > 0; --drive) {
    const double below = activation.Luminance((drive - 1) / 255.0);
    if (below < from) break;
    largest = std::max(largest, activation.Luminance(drive / 255.0) / below - 1);
  }
  return largest;
}

}  // namespace

double DriveThroughTable(const TableDesign& table, double u) {
  const double position = PositionOf(table.target, table.size, u);
  return DriveOfEntry(table.target, Interpolate(table.entries, position));
}

std::vector<ErrorPoint> ErrorCurve(const TableDesign& table, const Activation& activation,
                                   double u_from, int points) {
  std::vector<ErrorPoint> curve;
  for (int i = 0; i < points; ++i) {
    const double x = std::pow(u_from, 1 - static_cast<double>(i) / (points - 1));
    curve.push_back({x, ErrorAt(table, activation, x)});
  }
  return curve;
}

Certificate Certify(const TableDesign& table, const Activation& activation,
                    const DesignOptions& options) {
  Certificate certificate;
  certificate.u_from = options.u_from;
  certificate.samples = options.samples;
  std::vector<ErrorPoint> points = ErrorCurve(table, activation, options.u_from, options.samples);
  double squares = 0;
  for (const ErrorPoint& point : points) squares += point.relative_error * point.relative_error;
  certificate.rms_relative = std::sqrt(squares / options.samples);
  std::vector<double> bends = {CutoffOf(activation)};
  for (double knot_u : table.knots_u) bends.push_back(knot_u / table.white_u);
  for (double x : bends) {
    if (x > options.u_from && x < 1) points.push_back({x, ErrorAt(table, activation, x)});
  }
  for (const ErrorPoint& point : points) {
    if (std::abs(point.relative_error) <= certificate.max_relative) continue;
    certificate.max_relative = std::abs(point.relative_error);
    certificate.at_u = point.u;
  }
  certificate.contrast_step_8bit = LargestStepAt8Bits(activation, options.u_from);
  return certificate;
}

}  // namespace eyebox::fit
