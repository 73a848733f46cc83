// The small regressions of EMVA 1288, each with its uncertainty.
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_LINE_FIT_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_LINE_FIT_H_

#include <optional>
#include <span>

namespace eyebox::optics {

// A value and its standard uncertainty (k = 1), in the same unit.
struct Quantity {
  double value = 0;
  double sigma = 0;
};

struct LinePoint {
  double x = 0;
  double y = 0;
  double y_sigma = 0;  // independent from point to point
};

// y = slope x, unweighted, as the standard fits K and R. The uncertainty is propagated from
// y_sigma, and scaled by the root of the reduced chi^2 where the points scatter more than that.
// `common_y_sigma` is an error that all y share (a dark value subtracted from each).
// Empty if no x differs from 0.
std::optional<Quantity> FitThroughOrigin(std::span<const LinePoint> points,
                                         double common_y_sigma = 0);

struct OffsetLine {
  Quantity slope;
  Quantity offset;
};

// y = slope x + offset, unweighted; uncertainties as above. Empty for fewer than two different x.
std::optional<OffsetLine> FitOffsetLine(std::span<const LinePoint> points);

// y = slope x + offset with the least sum of squares of the residuals relative to y: the linearity
// fit of releases 3.1 and 4.0. Points with y <= 0 must not occur. Empty as above.
std::optional<OffsetLine> FitRelativeLine(std::span<const LinePoint> points);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_LINE_FIT_H_
