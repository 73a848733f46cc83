#include "optics/sensor/emva1288/line_fit.h"

#include <algorithm>
#include <cmath>

namespace eyebox::optics {
namespace {

// Factor by which the scatter of the points exceeds what their sigmas explain, at least 1. Points
// without a sigma tell nothing.
double ExcessScatter(std::span<const LinePoint> points, double slope, double offset,
                     double parameters) {
  double chi2 = 0;
  double counted = 0;
  for (const LinePoint& point : points) {
    if (!(point.y_sigma > 0)) continue;
    const double pull = (point.y - slope * point.x - offset) / point.y_sigma;
    chi2 += pull * pull;
    ++counted;
  }
  return counted > parameters ? std::max(std::sqrt(chi2 / (counted - parameters)), 1.0) : 1.0;
}

// Sums of least squares with weight w on each point, x relative to the weighted mean.
template <typename Weight>
std::optional<OffsetLine> FitWeighted(std::span<const LinePoint> points, const Weight& weight_of) {
  double weights = 0;
  double x_mean = 0;
  double y_mean = 0;
  for (const LinePoint& point : points) {
    const double w = weight_of(point);
    weights += w;
    x_mean += w * point.x;
    y_mean += w * point.y;
  }
  x_mean /= weights;
  y_mean /= weights;
  double xx = 0;
  double xy = 0;
  for (const LinePoint& point : points) {
    const double w = weight_of(point);
    xx += w * (point.x - x_mean) * (point.x - x_mean);
    xy += w * (point.x - x_mean) * (point.y - y_mean);
  }
  if (!(xx > 1e-20 * weights * x_mean * x_mean) || !(xx > 0)) return std::nullopt;
  OffsetLine line;
  line.slope.value = xy / xx;
  line.offset.value = y_mean - line.slope.value * x_mean;
  double slope_variance = 0;
  double offset_variance = 0;
  for (const LinePoint& point : points) {
    const double slope_part = weight_of(point) * (point.x - x_mean) / xx;
    const double offset_part = weight_of(point) / weights - slope_part * x_mean;
    slope_variance += slope_part * slope_part * point.y_sigma * point.y_sigma;
    offset_variance += offset_part * offset_part * point.y_sigma * point.y_sigma;
  }
  const double excess = ExcessScatter(points, line.slope.value, line.offset.value, 2);
  line.slope.sigma = excess * std::sqrt(slope_variance);
  line.offset.sigma = excess * std::sqrt(offset_variance);
  return line;
}

}  // namespace

std::optional<Quantity> FitThroughOrigin(std::span<const LinePoint> points, double common_y_sigma) {
  double xx = 0;
  double xy = 0;
  double x_sum = 0;
  double variance = 0;
  for (const LinePoint& point : points) {
    xx += point.x * point.x;
    xy += point.x * point.y;
    x_sum += point.x;
    variance += point.x * point.x * point.y_sigma * point.y_sigma;
  }
  if (!(xx > 0)) return std::nullopt;
  const double slope = xy / xx;
  const double independent = ExcessScatter(points, slope, 0, 1) * std::sqrt(variance) / xx;
  return Quantity{slope, std::hypot(independent, common_y_sigma * x_sum / xx)};
}

std::optional<OffsetLine> FitOffsetLine(std::span<const LinePoint> points) {
  if (points.size() < 2) return std::nullopt;
  return FitWeighted(points, [](const LinePoint&) { return 1.0; });
}

std::optional<OffsetLine> FitRelativeLine(std::span<const LinePoint> points) {
  if (points.size() < 2) return std::nullopt;
  return FitWeighted(points, [](const LinePoint& point) { return 1 / (point.y * point.y); });
}

}  // namespace eyebox::optics
