#include "fit/cube/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace eyebox::fit {
namespace {

constexpr int kTop = 255;
constexpr int kReach = 16;
constexpr double kNever = std::numeric_limits<double>::infinity();
// Only decides where no point of the range does.
constexpr double kDistanceWeight = 1e-9;

int Nearest(double entry) { return static_cast<int>(std::lround(kTop * entry)); }

struct Cost {
  double worst = kNever;
  double squares = kNever;
};

// Gives up on a pair of levels as soon as it exceeds `limit`: nearly all do at the first points.
Cost CostOf(const Activation& activation, int from, int to, std::span<const DesignPoint> points,
            double limit) {
  if (from > to) return {};
  Cost cost{0, 0};
  for (const DesignPoint& point : points) {
    const double drive = ((1 - point.weight) * from + point.weight * to) / kTop;
    const double error = activation.Luminance(drive) / point.wanted - 1;
    if (std::abs(error) > limit) return {};
    cost.worst = std::max(cost.worst, std::abs(error));
    cost.squares += error * error;
  }
  return cost;
}

// The levels that one entry may take: lowest, lowest + 1, ...
struct Levels {
  int lowest = 0;
  int count = 0;
  double target = 0;  // the entry before rounding, in levels

  int At(int k) const { return lowest + k; }
  double Distance(int k) const { return kDistanceWeight * (At(k) - target) * (At(k) - target); }
};

// The entries that take part in the range, and what each pair of neighbours costs.
class Rounding {
 public:
  Rounding(const Activation& activation, const std::vector<double>& entries,
           const std::vector<DesignPoint>& points) {
    const int first = points.front().interval;
    const int last = points.back().interval + 1;
    for (int i = first; i <= last; ++i) {
      const double target = kTop * entries[static_cast<size_t>(i)];
      const int reach = i == first ? kTop : kReach;
      const int nearest = static_cast<int>(std::lround(target));
      const int lowest = std::max(nearest - reach, 0);
      levels_.push_back({lowest, std::min(nearest + reach, kTop) - lowest + 1, target});
    }
    Price(activation, points, WorstOfNearest(activation, entries, points));
  }

  // The levels of the entries in the range.
  std::vector<int> Best() const { return SmallestSquares(SmallestWorst()); }

 private:
  static double WorstOfNearest(const Activation& activation, const std::vector<double>& entries,
                               const std::vector<DesignPoint>& points) {
    double worst = 0;
    for (const DesignPoint& point : points) {
      const size_t i = static_cast<size_t>(point.interval);
      const Cost cost = CostOf(activation, Nearest(entries[i]), Nearest(entries[i + 1]),
                               std::span(&point, 1), kNever);
      worst = std::max(worst, cost.worst);
    }
    return worst;
  }

  void Price(const Activation& activation, std::span<const DesignPoint> points, double limit) {
    const int first = points.front().interval;
    size_t begin = 0;
    for (size_t i = 0; i + 1 < levels_.size(); ++i) {
      size_t end = begin;
      while (end < points.size() && points[end].interval == first + static_cast<int>(i)) ++end;
      const auto own = points.subspan(begin, end - begin);
      std::vector<Cost>& costs = costs_.emplace_back();
      for (int from = 0; from < levels_[i].count; ++from) {
        for (int to = 0; to < levels_[i + 1].count; ++to) {
          costs.push_back(
              CostOf(activation, levels_[i].At(from), levels_[i + 1].At(to), own, limit));
        }
      }
      begin = end;
    }
  }

  const Cost& CostFrom(size_t i, int from, int to) const {
    return costs_[i][static_cast<size_t>(from * levels_[i + 1].count + to)];
  }

  double SmallestWorst() const {
    std::vector<double> worst(levels_.front().count, 0);
    for (size_t i = 0; i < costs_.size(); ++i) {
      std::vector<double> next(levels_[i + 1].count, kNever);
      for (int from = 0; from < levels_[i].count; ++from) {
        for (int to = 0; to < levels_[i + 1].count; ++to) {
          next[to] = std::min(next[to], std::max(worst[from], CostFrom(i, from, to).worst));
        }
      }
      worst = next;
    }
    return *std::ranges::min_element(worst);
  }

  std::vector<int> SmallestSquares(double worst_allowed) const {
    std::vector<double> sum;
    for (int k = 0; k < levels_.front().count; ++k) sum.push_back(levels_.front().Distance(k));
    std::vector<std::vector<int>> came_from;
    for (size_t i = 0; i < costs_.size(); ++i) {
      std::vector<double> next(levels_[i + 1].count, kNever);
      std::vector<int>& came = came_from.emplace_back(levels_[i + 1].count, 0);
      for (int from = 0; from < levels_[i].count; ++from) {
        for (int to = 0; to < levels_[i + 1].count; ++to) {
          const Cost& cost = CostFrom(i, from, to);
          const double total = sum[from] + cost.squares + levels_[i + 1].Distance(to);
          if (cost.worst > worst_allowed || total >= next[to]) continue;
          next[to] = total;
          came[to] = from;
        }
      }
      sum = next;
    }
    return Trace(came_from, static_cast<int>(std::ranges::min_element(sum) - sum.begin()));
  }

  std::vector<int> Trace(const std::vector<std::vector<int>>& came_from, int last) const {
    std::vector<int> levels(levels_.size());
    for (size_t i = levels_.size(); i-- > 0;) {
      levels[i] = levels_[i].At(last);
      if (i > 0) last = came_from[i - 1][last];
    }
    return levels;
  }

  std::vector<Levels> levels_;            // [entries in the range]
  std::vector<std::vector<Cost>> costs_;  // [entries - 1][from, to]
};

}  // namespace

std::vector<double> RoundTo8Bits(const Activation& activation, const std::vector<double>& entries,
                                 const std::vector<DesignPoint>& points) {
  const std::vector<int> best = Rounding(activation, entries, points).Best();
  const size_t first = static_cast<size_t>(points.front().interval);
  std::vector<double> rounded;
  for (size_t i = 0; i < entries.size(); ++i) {
    int level = Nearest(entries[i]);
    if (i < first) level = std::min(level, best.front());
    if (i >= first)
      level = i - first < best.size() ? best[i - first] : std::max(level, best.back());
    rounded.push_back(static_cast<double>(level) / kTop);
  }
  return rounded;
}

}  // namespace eyebox::fit
