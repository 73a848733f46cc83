#include "service/report/raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace eyebox::service::report {
namespace {

float BlockMean(std::span<const float> values, ImageSize size, int x0, int y0, int block) {
  double sum = 0;
  int count = 0;
  for (int y = y0; y < std::min(y0 + block, size.height_px); ++y) {
    for (int x = x0; x < std::min(x0 + block, size.width_px); ++x) {
      const float value = values[static_cast<size_t>(y) * size.width_px + x];
      if (std::isnan(value)) continue;
      sum += value;
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
}

// Where the level is crossed between two neighbouring cell centres, if it is.
std::optional<Point> Crossing(Point a, double value_a, Point b, double value_b, double level) {
  if ((value_a < level) == (value_b < level)) return std::nullopt;
  const double share = (level - value_a) / (value_b - value_a);
  return Point{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

// The segments of `level` in the square whose upper left corner is the centre of cell (x, y).
void AddSquare(const Image<float>& map, int x, int y, double level,
               std::vector<Segment>& segments) {
  const std::array<Point, 4> corner = {
      {{x + 0.5, y + 0.5}, {x + 1.5, y + 0.5}, {x + 1.5, y + 1.5}, {x + 0.5, y + 1.5}}};
  const std::array<double, 4> value = {map.at(x, y), map.at(x + 1, y), map.at(x + 1, y + 1),
                                       map.at(x, y + 1)};
  if (std::any_of(value.begin(), value.end(), [](double v) { return std::isnan(v); })) return;
  std::vector<Point> crossings;
  for (size_t i = 0; i < 4; ++i) {
    const size_t next = (i + 1) % 4;
    if (auto point = Crossing(corner[i], value[i], corner[next], value[next], level)) {
      crossings.push_back(*point);
    }
  }
  // A saddle is crossed on all four sides; either pairing is a faithful drawing of it.
  for (size_t i = 0; i + 1 < crossings.size(); i += 2) {
    segments.push_back({crossings[i], crossings[i + 1]});
  }
}

}  // namespace

int BlockSize(ImageSize size, int longest_side) {
  const int side = std::max(size.width_px, size.height_px);
  return (side + longest_side - 1) / longest_side;
}

Image<float> Shrunk(std::span<const float> values, ImageSize size, int longest_side) {
  const int block = BlockSize(size, longest_side);
  Image<float> shrunk({(size.width_px + block - 1) / block, (size.height_px + block - 1) / block});
  for (int y = 0; y < shrunk.size().height_px; ++y) {
    for (int x = 0; x < shrunk.size().width_px; ++x) {
      shrunk.at(x, y) = BlockMean(values, size, x * block, y * block, block);
    }
  }
  return shrunk;
}

std::optional<Range> RangeOf(std::span<const float> values) {
  std::optional<Range> range;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    if (!range) range = {value, value};
    range->minimum = std::min<double>(range->minimum, value);
    range->maximum = std::max<double>(range->maximum, value);
  }
  return range;
}

std::vector<Segment> Contour(const Image<float>& map, double level) {
  std::vector<Segment> segments;
  for (int y = 0; y + 1 < map.size().height_px; ++y) {
    for (int x = 0; x + 1 < map.size().width_px; ++x) AddSquare(map, x, y, level, segments);
  }
  return segments;
}

}  // namespace eyebox::service::report
