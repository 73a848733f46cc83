#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "service/report/axis.h"
#include "service/report/figures.h"
#include "service/report/svg.h"
#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

constexpr double kLeft = 78;
constexpr double kRight = 640;
constexpr double kTop = 14;
constexpr double kBottom = 270;
constexpr size_t kColours = 4;  // of the style sheet

Range CertifiedRange(const std::vector<CertificateRow>& certificates, Range whole) {
  if (certificates.empty()) return whole;
  Range range = certificates.front().u;
  for (const CertificateRow& row : certificates) {
    range = {std::min(range.minimum, row.u.minimum), std::max(range.maximum, row.u.maximum)};
  }
  return range;
}

Range WholeRange(const std::vector<ErrorCurve>& curves) {
  Range range{std::numeric_limits<double>::max(), 0};
  for (const ErrorCurve& curve : curves) {
    range.minimum = std::min(range.minimum, curve.points.front().u);
    range.maximum = std::max(range.maximum, curve.points.back().u);
  }
  return range;
}

// Errors below the certified range are large by nature (the display's minimum luminance) and would
// flatten what matters.
const ErrorPoint* WorstOf(const ErrorCurve& curve, Range certified) {
  const ErrorPoint* worst = nullptr;
  for (const ErrorPoint& point : curve.points) {
    if (point.u < certified.minimum || point.u > certified.maximum) continue;
    if (!worst || std::abs(point.relative_error) > std::abs(worst->relative_error)) worst = &point;
  }
  return worst;
}

double LargestPercent(const std::vector<ErrorCurve>& curves, Range certified) {
  double largest = 0;
  for (const ErrorCurve& curve : curves) {
    if (const ErrorPoint* worst = WorstOf(curve, certified)) {
      largest = std::max(largest, 100 * std::abs(worst->relative_error));
    }
  }
  return largest > 0 ? largest : 1;
}

void DrawLegend(Svg& svg, const std::vector<ErrorCurve>& curves) {
  for (size_t i = 0; i < curves.size(); ++i) {
    const double y = kTop + 18 + 18 * static_cast<double>(i);
    svg.Line({{kRight - 34, y - 4}, {kRight - 10, y - 4}},
             fmt::format("curve curve-{}", i % kColours));
    svg.Text({kRight - 40, y}, curves[i].label, Anchor::kEnd, "number");
  }
}

}  // namespace

std::string DrawErrorCurves(const std::vector<ErrorCurve>& curves,
                            const std::vector<CertificateRow>& certificates, std::string_view id) {
  const Range whole = WholeRange(curves);
  const Range certified = CertifiedRange(certificates, whole);
  const double percent = 1.5 * LargestPercent(curves, certified);
  const Panel panel{LogarithmicAxis({whole.minimum, whole.maximum * 1.05}, kLeft, kRight),
                    LinearAxis({-percent, percent}, kBottom, kTop), "u, as a fraction of white",
                    "luminance error (%)"};
  Svg svg(kRight + 16, kBottom + 50, "Relative luminance error that the tables leave");
  svg.BeginClip(id, {panel.left(), panel.top()}, panel.width(), panel.height());
  const double from = panel.x.Position(certified.minimum);
  svg.Rectangle({from, kTop}, panel.x.Position(certified.maximum) - from, panel.height(),
                "class=\"certified\"");
  DrawGrid(svg, panel);
  svg.Line({{kLeft, panel.y.Position(0)}, {kRight, panel.y.Position(0)}}, "zero");
  for (size_t i = 0; i < curves.size(); ++i) {
    std::vector<Point> points;
    for (const ErrorPoint& p : curves[i].points) {
      points.push_back(panel.At(p.u, 100 * p.relative_error));
    }
    svg.Polyline(points, fmt::format("curve curve-{}", i % kColours));
    if (const ErrorPoint* worst = WorstOf(curves[i], certified)) {
      svg.Circle(panel.At(worst->u, 100 * worst->relative_error), 4, "worst");
    }
  }
  svg.EndClip();
  DrawLegend(svg, curves);
  DrawFrame(svg, panel);
  return std::move(svg).Finish();
}

}  // namespace eyebox::service::report
