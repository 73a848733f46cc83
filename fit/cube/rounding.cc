#include "fit/cube/rounding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace eyebox::fit {
namespace {

constexpr double kTop = 255;
constexpr int kCandidates = 8;  // floor - 3 .. floor + 4
constexpr int kBelow = 3;
constexpr double kNever = std::numeric_limits<double>::infinity();
// Only decides where no point of the range does.
constexpr double kDistanceWeight = 1e-9;

struct Cost {
  double worst = 0;
  double squares = 0;
};
// [candidate of entry i][candidate of entry i + 1]
using Costs = std::array<std::array<Cost, kCandidates>, kCandidates>;
using Levels = std::array<double, kCandidates>;  // 0 .. 255, or out of it: not allowed

Levels LevelsAround(double entry) {
  Levels levels{};
  for (int k = 0; k < kCandidates; ++k) levels[k] = std::floor(kTop * entry) - kBelow + k;
  return levels;
}

bool Holds(double level) { return level >= 0 && level <= kTop; }

Cost CostOf(const Activation& activation, double from, double to, const DesignPoint* begin,
            const DesignPoint* end) {
  if (!Holds(from) || !Holds(to) || from > to) return {kNever, kNever};
  Cost cost;
  for (const DesignPoint* point = begin; point != end; ++point) {
    const double drive = std::lerp(from, to, point->weight) / kTop;
    const double error = activation.Luminance(drive) / point->wanted - 1;
    cost.worst = std::max(cost.worst, std::abs(error));
    cost.squares += error * error;
  }
  return cost;
}

class Rounding {
 public:
  Rounding(const Activation& activation, const std::vector<double>& entries,
           const std::vector<DesignPoint>& points)
      : entries_(entries), costs_(entries.size() - 1) {
    for (double entry : entries) levels_.push_back(LevelsAround(entry));
    const DesignPoint* begin = points.data();
    const DesignPoint* const stop = begin + points.size();
    for (size_t i = 0; i < costs_.size(); ++i) {
      const DesignPoint* end = begin;
      while (end != stop && end->interval == static_cast<int>(i)) ++end;
      for (int from = 0; from < kCandidates; ++from) {
        for (int to = 0; to < kCandidates; ++to) {
          costs_[i][from][to] =
              CostOf(activation, levels_[i][from], levels_[i + 1][to], begin, end);
        }
      }
      begin = end;
    }
  }

  double SmallestWorst() const {
    std::array<double, kCandidates> worst{};
    for (const Costs& costs : costs_) {
      std::array<double, kCandidates> next;
      next.fill(kNever);
      for (int to = 0; to < kCandidates; ++to) {
        for (int from = 0; from < kCandidates; ++from) {
          next[to] = std::min(next[to], std::max(worst[from], costs[from][to].worst));
        }
      }
      worst = next;
    }
    return *std::ranges::min_element(worst);
  }

  std::vector<double> SmallestSquares(double worst_allowed) const {
    std::array<double, kCandidates> sum{};
    for (int k = 0; k < kCandidates; ++k) sum[k] = Distance(0, k);
    std::vector<std::array<int, kCandidates>> came_from(costs_.size());
    for (size_t i = 0; i < costs_.size(); ++i) {
      std::array<double, kCandidates> next;
      next.fill(kNever);
      for (int to = 0; to < kCandidates; ++to) {
        for (int from = 0; from < kCandidates; ++from) {
          if (costs_[i][from][to].worst > worst_allowed) continue;
          const double total = sum[from] + costs_[i][from][to].squares + Distance(i + 1, to);
          if (total >= next[to]) continue;
          next[to] = total;
          came_from[i][to] = from;
        }
      }
      sum = next;
    }
    return Trace(came_from, static_cast<int>(std::ranges::min_element(sum) - sum.begin()));
  }

 private:
  double Distance(size_t i, int candidate) const {
    const double steps = levels_[i][candidate] - kTop * entries_[i];
    return kDistanceWeight * steps * steps;
  }

  std::vector<double> Trace(const std::vector<std::array<int, kCandidates>>& came_from,
                            int last) const {
    std::vector<double> rounded(levels_.size());
    for (size_t i = levels_.size(); i-- > 0;) {
      rounded[i] = levels_[i][last] / kTop;
      if (i > 0) last = came_from[i - 1][last];
    }
    return rounded;
  }

  const std::vector<double>& entries_;
  std::vector<Levels> levels_;  // [entries]
  std::vector<Costs> costs_;    // [entries - 1]
};

}  // namespace

std::vector<double> RoundTo8Bits(const Activation& activation, const std::vector<double>& entries,
                                 const std::vector<DesignPoint>& points) {
  const Rounding rounding(activation, entries, points);
  return rounding.SmallestSquares(rounding.SmallestWorst());
}

}  // namespace eyebox::fit
