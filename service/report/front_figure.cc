#include "service/report/front_figure.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "service/report/alone.h"
#include "service/report/axis.h"
#include "service/report/svg.h"

namespace eyebox::service::report {
namespace {

constexpr double kLeft = 78;
constexpr double kRight = 760;
constexpr double kTop = 14;
constexpr double kBottom = 420;
constexpr double kPointRadius = 3.2;
constexpr double kMargin = 1.25;  // factor around what is shown
constexpr double kLabelDx = 6;
constexpr double kLabelBelow = 16;     // every other one, so that neighbours do not overlap
constexpr double kLabelsTurnAt = 0.6;  // of the width: further right they stand left of the point

Range Around(const std::vector<FrontPoint>& points, double FrontPoint::*first,
             double FrontPoint::*second) {
  Range range{points[0].*first, points[0].*first};
  for (const FrontPoint& point : points) {
    for (const double value : {point.*first, point.*second}) {
      range = {std::min(range.minimum, value), std::max(range.maximum, value)};
    }
  }
  return {range.minimum / kMargin, range.maximum * kMargin};
}

void DrawFront(Svg& svg, const Panel& panel, std::vector<FrontPoint> points) {
  std::erase_if(points, [](const FrontPoint& point) { return !point.on_front; });
  std::ranges::sort(points, {}, &FrontPoint::seconds);
  std::vector<Point> line;
  for (const FrontPoint& point : points) {
    line.push_back(panel.At(point.seconds, point.error_percent));
    const bool at_right = line.back().x > kLeft + kLabelsTurnAt * (kRight - kLeft);
    svg.Text({line.back().x + (at_right ? -kLabelDx : kLabelDx),
              line.back().y + (line.size() % 2 == 1 ? kLabelBelow : -kLabelDx)},
             point.label, at_right ? Anchor::kEnd : Anchor::kStart, "number");
  }
  svg.Polyline(line, "curve curve-1");
}

void DrawPoint(Svg& svg, const Panel& panel, const FrontPoint& point) {
  const Point measured = panel.At(point.seconds, point.error_percent);
  svg.Line({measured, panel.At(point.seconds, point.predicted_percent)}, "grid");
  const double low = std::max(point.error_percent - point.error_sigma, panel.y.values.minimum);
  const Segment bar{panel.At(point.seconds, low),
                    panel.At(point.seconds, point.error_percent + point.error_sigma)};
  if (bar.from.y - bar.to.y > 2 * kPointRadius) svg.Line(bar, "error-bar");
  svg.Circle(measured, kPointRadius, point.on_front ? "worst" : "point");
}

}  // namespace

std::string DrawFrontAlone(const std::vector<FrontPoint>& points) {
  if (points.empty()) return "";
  Svg svg(kRight + 16, kBottom + 50, "Relative error of the luminance against capture time");
  const Panel panel{
      LogarithmicAxis(Around(points, &FrontPoint::seconds, &FrontPoint::seconds), kLeft, kRight),
      LogarithmicAxis(Around(points, &FrontPoint::error_percent, &FrontPoint::predicted_percent),
                      kBottom, kTop),
      "time of the captures (s)", "rms error (%)"};
  DrawGrid(svg, panel);
  for (const FrontPoint& point : points) DrawPoint(svg, panel, point);
  DrawFront(svg, panel, points);
  DrawFrame(svg, panel);
  return AloneInFile(std::move(svg).Finish());
}

}  // namespace eyebox::service::report
