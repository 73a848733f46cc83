#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "capture/base/image_file.h"
#include "capture/base/status.h"
#include "service/report/axis.h"
#include "service/report/colour_map.h"
#include "service/report/figures.h"
#include "service/report/raster.h"
#include "service/report/svg.h"
#include "service/report/text.h"

namespace eyebox::service::report {
namespace {

constexpr double kLeft = 70;
constexpr double kTop = 14;
constexpr double kLongestSide = 520;
constexpr double kBarGap = 28;
constexpr double kBarWidth = 18;
constexpr int kMostCells = 520;        // no more than the page can show
constexpr int kMostContourCells = 96;  // coarse enough to average the noise out of the lines

// Pixel position (0 is the left or upper edge) of `angle` among the angles of pixel centres.
double PixelOf(double angle, const std::vector<double>& centre_deg) {
  const bool rising = centre_deg.front() < centre_deg.back();
  const auto before = [rising](double a, double b) { return rising ? a < b : a > b; };
  const auto above = std::lower_bound(centre_deg.begin(), centre_deg.end(), angle, before);
  const auto last = static_cast<std::ptrdiff_t>(centre_deg.size()) - 1;
  const auto i = std::clamp<std::ptrdiff_t>(above - centre_deg.begin(), 1, last);
  const double share = (angle - centre_deg[i - 1]) / (centre_deg[i] - centre_deg[i - 1]);
  return static_cast<double>(i) - 0.5 + share;
}

// The axis in pixels, with ticks at round numbers of what it is labelled in.
Axis MapAxis(int pixels, const std::vector<double>& centre_deg, double from, double to) {
  Axis axis{Scale::kLinear, {0, static_cast<double>(pixels)}, from, to, {}};
  if (centre_deg.size() < 2) {
    axis.ticks = LinearTicks(axis.values, 6);
    return axis;
  }
  const auto [low, high] = std::minmax(centre_deg.front(), centre_deg.back());
  axis.ticks = LinearTicks({low, high}, 6);
  for (Tick& tick : axis.ticks) tick.value = PixelOf(tick.value, centre_deg);
  return axis;
}

Panel MapPanel(const MapFigure& map) {
  const double scale = kLongestSide / std::max(map.size.width_px, map.size.height_px);
  const double right = kLeft + scale * map.size.width_px;
  const double bottom = kTop + scale * map.size.height_px;
  const bool in_degrees = !map.column_deg.empty();
  Panel panel{MapAxis(map.size.width_px, map.column_deg, kLeft, right),
              MapAxis(map.size.height_px, map.row_deg, bottom, kTop),
              in_degrees ? "horizontal field angle (deg)" : "column (px)",
              in_degrees ? "vertical field angle (deg)" : "row (px)"};
  // Row 0 is at the top, where the axis ends.
  for (Tick& tick : panel.y.ticks) tick.value = map.size.height_px - tick.value;
  return panel;
}

void DrawContours(Svg& svg, const MapFigure& map, const Panel& panel) {
  const auto source = map.contoured.empty() ? map.values : map.contoured;
  const Image<float> coarse = Shrunk(source, map.size, kMostContourCells);
  const double cell = BlockSize(map.size, kMostContourCells) * panel.width() / map.size.width_px;
  for (const double level : map.contours) {
    std::vector<Segment> lines = Contour(coarse, level);
    if (lines.empty()) continue;
    for (Segment& line : lines) {
      for (Point* end : {&line.from, &line.to}) {
        *end = {panel.left() + cell * end->x, panel.top() + cell * end->y};
      }
    }
    svg.Segments(lines, "contour");
    // Labels stand along the diagonal to the lower right, apart from each other.
    const auto off_diagonal = [&panel](const Segment& s) {
      const double x = (s.from.x - panel.left()) / panel.width();
      const double y = (s.from.y - panel.top()) / panel.height();
      return std::abs(x - y) + (x < 0.5 ? 2 : 0);
    };
    const auto label = std::min_element(lines.begin(), lines.end(), [&](auto& a, auto& b) {
      return off_diagonal(a) < off_diagonal(b);
    });
    svg.Text({label->from.x, label->from.y + 4}, fmt::format("{:g}", level), Anchor::kMiddle,
             "contour-label");
  }
}

absl::Status DrawColourBar(Svg& svg, const MapFigure& map, const Panel& panel, Range range) {
  constexpr int kSteps = 256;
  Image<float> ramp({1, kSteps});
  for (int y = 0; y < kSteps; ++y) ramp.at(0, y) = static_cast<float>(kSteps - 1 - y);
  EYEBOX_ASSIGN_OR_RETURN(const std::string png, EncodePng(Coloured(ramp, {0, kSteps - 1})));
  const double left = panel.x.to + kBarGap;
  svg.Picture({left, panel.top()}, kBarWidth, panel.height(), png, false);
  svg.Rectangle({left, panel.top()}, kBarWidth, panel.height(), "class=\"frame\"");
  const Axis axis = LinearAxis(range, panel.y.from, panel.y.to, 7);
  for (const Tick& tick : axis.ticks) {
    const double y = axis.Position(tick.value);
    svg.Line({{left + kBarWidth, y}, {left + kBarWidth + 5, y}}, "tick");
    svg.Text({left + kBarWidth + 9, y + 4}, tick.label, Anchor::kStart, "number");
  }
  svg.TextUpwards({left + kBarWidth + 62, panel.top() + panel.height() / 2},
                  WithUnit(map.quantity, map.unit), "label");
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::string> DrawMap(const MapFigure& map, std::string_view id) {
  const Panel panel = MapPanel(map);
  const Image<float> shown = Shrunk(map.values, map.size, kMostCells);
  Range range = map.range.value_or(RangeOf(shown.pixels()).value_or(Range{0, 1}));
  if (!(range.maximum > range.minimum)) range = Widened(range, 0.01);
  EYEBOX_ASSIGN_OR_RETURN(const std::string png, EncodePng(Coloured(shown, range)));

  Svg svg(panel.x.to + kBarGap + kBarWidth + 76, panel.y.from + 50, map.title);
  const Point corner{panel.left(), panel.top()};
  // Blocks at the rim may be cut, so the picture may reach a little beyond the map.
  const double block = BlockSize(map.size, kMostCells) * panel.width() / map.size.width_px;
  svg.BeginClip(id, corner, panel.width(), panel.height());
  svg.Picture(corner, block * shown.size().width_px, block * shown.size().height_px, png, false);
  DrawContours(svg, map, panel);
  svg.EndClip();
  DrawFrame(svg, panel);
  EYEBOX_RETURN_IF_ERROR(DrawColourBar(svg, map, panel, range));
  return std::move(svg).Finish();
}

}  // namespace eyebox::service::report
