#include "service/report/glare_figure.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "service/report/alone.h"
#include "service/report/axis.h"
#include "service/report/svg.h"
#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

constexpr double kLeft = 78;
constexpr double kRight = 640;
constexpr double kTop = 14;
constexpr double kBottom = 360;
constexpr double kPointRadius = 3.6;
constexpr double kBand = 2;       // sigmas
constexpr double kMargin = 1.15;  // factor around what is shown

// Readings off the axis are of another place than the curve is.
bool IsShown(const GlarePoint& point, const GlareFigureInput& input) {
  const double widest = input.curve.back().diameter_deg;
  return point.diameter_deg <= widest * 1.001 && point.offset_deg < point.diameter_deg / 4;
}

template <typename Include>
void ForAll(const GlareFigureInput& input, Include include) {
  for (const GlarePoint& p : input.readings) {
    if (IsShown(p, input)) include(p.diameter_deg, p.luminance);
  }
  for (const GlareCurvePoint& p : input.curve) include(p.diameter_deg, p.luminance);
}

Axis LuminanceAxis(const GlareFigureInput& input) {
  Range range{input.curve[0].luminance, input.curve[0].luminance};
  ForAll(input, [&range](double, double luminance) {
    range = {std::min(range.minimum, luminance), std::max(range.maximum, luminance)};
  });
  if (range.minimum <= 0) return LinearAxis(Widened(range, 0.05), kBottom, kTop);
  return LogarithmicAxis({range.minimum / kMargin, range.maximum * kMargin}, kBottom, kTop);
}

Axis DiameterAxis(const GlareFigureInput& input) {
  Range range{input.curve[0].diameter_deg, input.curve[0].diameter_deg};
  ForAll(input, [&range](double diameter, double) {
    range = {std::min(range.minimum, diameter), std::max(range.maximum, diameter)};
  });
  return LogarithmicAxis({range.minimum / kMargin, range.maximum * kMargin}, kLeft, kRight);
}

void DrawBand(Svg& svg, const Panel& panel, const GlareFigureInput& input) {
  for (const double side : {-kBand, kBand}) {
    std::vector<Point> line;
    for (const GlareCurvePoint& p : input.curve) {
      const double luminance = p.luminance + side * p.luminance_sigma;
      line.push_back(panel.At(
          p.diameter_deg, std::clamp(luminance, panel.y.values.minimum, panel.y.values.maximum)));
    }
    svg.Polyline(line, "grid");
  }
}

void DrawReadings(Svg& svg, const Panel& panel, const GlareFigureInput& input) {
  for (const GlarePoint& p : input.readings) {
    if (!IsShown(p, input)) continue;
    const auto at = [&](double luminance) {
      return panel.At(p.diameter_deg,
                      std::clamp(luminance, panel.y.values.minimum, panel.y.values.maximum));
    };
    const Segment bar{at(p.luminance - p.luminance_sigma), at(p.luminance + p.luminance_sigma)};
    if (bar.from.y - bar.to.y > 2 * kPointRadius) svg.Line(bar, "error-bar");
    svg.Circle(at(p.luminance), kPointRadius, "point");
  }
}

}  // namespace

std::string DrawGlare(const GlareFigureInput& input) {
  Svg svg(kRight + 16, kBottom + 50, "Reading in the middle of a disk against its diameter");
  const Panel panel{DiameterAxis(input), LuminanceAxis(input), "diameter of the disk (deg)",
                    WithUnit("reading", input.luminance_unit)};
  DrawGrid(svg, panel);
  DrawBand(svg, panel, input);
  std::vector<Point> curve;
  for (const GlareCurvePoint& p : input.curve)
    curve.push_back(panel.At(p.diameter_deg, p.luminance));
  svg.Polyline(curve, "curve curve-0");
  DrawReadings(svg, panel, input);
  DrawFrame(svg, panel);
  return std::move(svg).Finish();
}

std::string DrawGlareAlone(const GlareFigureInput& input) { return AloneInFile(DrawGlare(input)); }

}  // namespace eyebox::service::report
