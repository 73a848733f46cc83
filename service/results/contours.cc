#include "service/results/contours.h"

#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>

#include "service/report/raster.h"

namespace eyebox::service {
namespace {

constexpr int kWantedLines = 8;
constexpr int kMostCells = 96;
constexpr double kSamePoint = 1e-6;  // of a cell: squares agree on their common side to rounding

using Key = std::pair<int64_t, int64_t>;

Key KeyOf(const report::Point& point) {
  return {std::llround(point.x / kSamePoint), std::llround(point.y / kSamePoint)};
}

// Segments in any order to lines, each as long as it goes.
class Joiner {
 public:
  explicit Joiner(const std::vector<report::Segment>& segments)
      : segments_(segments), used_(segments.size(), false) {
    for (size_t i = 0; i < segments.size(); ++i) {
      at_.emplace(KeyOf(segments[i].from), i);
      at_.emplace(KeyOf(segments[i].to), i);
    }
  }

  std::vector<std::deque<report::Point>> Lines() {
    std::vector<std::deque<report::Point>> lines;
    for (size_t i = 0; i < segments_.size(); ++i) {
      if (used_[i]) continue;
      used_[i] = true;
      std::deque<report::Point> line = {segments_[i].from, segments_[i].to};
      while (const report::Point* next = Beyond(line.back())) line.push_back(*next);
      while (const report::Point* next = Beyond(line.front())) line.push_front(*next);
      lines.push_back(std::move(line));
    }
    return lines;
  }

 private:
  // The other end of an unused segment that begins here; nullptr if there is none.
  const report::Point* Beyond(const report::Point& point) {
    const Key key = KeyOf(point);
    const auto [first, last] = at_.equal_range(key);
    for (auto it = first; it != last; ++it) {
      if (used_[it->second]) continue;
      used_[it->second] = true;
      const report::Segment& segment = segments_[it->second];
      return KeyOf(segment.from) == key ? &segment.to : &segment.from;
    }
    return nullptr;
  }

  const std::vector<report::Segment>& segments_;
  std::vector<bool> used_;
  std::multimap<Key, size_t> at_;
};

}  // namespace

std::vector<double> ContourLevels(const optics::FieldRange& range) {
  const double wanted = (range.maximum - range.minimum) / kWantedLines;
  if (!(wanted > 1e-6)) return {};
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  const double step = decade * (wanted > 5 * decade ? 10 : wanted > 2 * decade ? 5 : 2);
  std::vector<double> levels;
  for (double k = std::ceil(range.minimum / step); k * step < range.maximum; ++k) {
    levels.push_back(k * step);
  }
  return levels;
}

std::vector<v1::ContourLine> ContourLines(const Image<float>& map, std::span<const double> levels) {
  const int block = report::BlockSize(map.size(), kMostCells);
  const Image<float> cells = report::Shrunk(map.pixels(), map.size(), kMostCells);
  std::vector<v1::ContourLine> lines;
  for (const double level : levels) {
    const std::vector<report::Segment> segments = report::Contour(cells, level);
    for (const auto& points : Joiner(segments).Lines()) {
      v1::ContourLine line;
      line.set_g(level);
      for (const report::Point& point : points) {
        line.add_x_px(point.x * block - 0.5);
        line.add_y_px(point.y * block - 0.5);
      }
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace eyebox::service
