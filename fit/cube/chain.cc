#include "fit/cube/chain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace eyebox::fit {
namespace {

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double Clamp(double value) const { return std::min(std::max(value, low), high); }
};

struct Point {
  double a = 0;  // lower entry of the interval
  double b = 0;  // upper entry
};

// The convex set of pairs (a, b) that one interval allows.
class Polygon {
 public:
  Polygon(Range a, double b_cap)
      : corners_{{a.low, 0}, {a.high, 0}, {a.high, b_cap}, {a.low, b_cap}} {}

  // Keeps what has p a + q b <= limit.
  void Keep(double p, double q, double limit) {
    const auto excess = [&](const Point& point) { return p * point.a + q * point.b - limit; };
    if (std::ranges::all_of(corners_, [&](const Point& c) { return excess(c) <= 0; })) return;
    kept_.clear();
    for (size_t i = 0; i < corners_.size(); ++i) {
      const Point& from = corners_[i];
      const Point& to = corners_[(i + 1) % corners_.size()];
      const double from_excess = excess(from);
      const double to_excess = excess(to);
      if (from_excess <= 0) kept_.push_back(from);
      if ((from_excess <= 0) != (to_excess <= 0)) {
        const double share = from_excess / (from_excess - to_excess);
        kept_.push_back({std::lerp(from.a, to.a, share), std::lerp(from.b, to.b, share)});
      }
    }
    corners_.swap(kept_);
  }

  bool empty() const { return corners_.empty(); }

  Range RangeOfB() const {
    Range range;
    for (const Point& corner : corners_) range.Include(corner.b);
    return range;
  }

  // The a that go with one b of RangeOfB().
  Range RangeOfA(double b) const {
    Range range;
    for (size_t i = 0; i < corners_.size(); ++i) {
      const Point& from = corners_[i];
      const Point& to = corners_[(i + 1) % corners_.size()];
      if (from.b == b) range.Include(from.a);
      if ((from.b < b) == (to.b < b)) continue;
      range.Include(std::lerp(from.a, to.a, (b - from.b) / (to.b - from.b)));
    }
    return range;
  }

 private:
  std::vector<Point> corners_;
  std::vector<Point> kept_;
};

Polygon PolygonOf(Range a, double b_cap, std::span<const MixBound> bounds) {
  Polygon polygon(a, b_cap);
  polygon.Keep(1, -1, 0);
  for (const MixBound& bound : bounds) {
    if (polygon.empty()) break;
    const double p = 1 - bound.weight;
    const double q = bound.weight;
    if (std::isfinite(bound.high)) polygon.Keep(p, q, bound.high);
    polygon.Keep(-p, -q, -bound.low);
  }
  return polygon;
}

}  // namespace

std::optional<std::vector<double>> SolveChain(const ChainProblem& problem) {
  Range range{0, problem.cap.front()};
  std::vector<Polygon> polygons;
  for (size_t i = 0; i < problem.intervals.size(); ++i) {
    polygons.push_back(PolygonOf(range, problem.cap[i + 1], problem.intervals[i]));
    if (polygons.back().empty()) return std::nullopt;
    range = polygons.back().RangeOfB();
  }
  std::vector<double> entries(problem.cap.size());
  entries.back() = range.Clamp(problem.preferred.back());
  for (size_t i = polygons.size(); i-- > 0;) {
    entries[i] = polygons[i].RangeOfA(entries[i + 1]).Clamp(problem.preferred[i]);
    // The crossing of two edges is rounded; the order of the entries must not be.
    entries[i] = std::min(entries[i], entries[i + 1]);
  }
  return entries;
}

}  // namespace eyebox::fit
