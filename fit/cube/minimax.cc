#include "fit/cube/minimax.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fit/cube/bisection.h"
#include "fit/cube/chain.h"
#include "fit/cube/goal.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

constexpr int kPointsPerInterval = 48;
constexpr int kPointsAtLeast = 512;
constexpr int kLogPoints = 512;
// An entry above white is held down by few points, if any. It stays within what half floats, the
// usual storage of such a table, can hold.
constexpr double kRoomAboveIdeal = 4;
constexpr double kLargestHalf = 65504;

DesignPoint PointAt(const Activation& activation, int size, double x, double position) {
  const double below = std::clamp(std::floor(position), 0.0, static_cast<double>(size - 2));
  return {x, static_cast<int>(below), position - below, WantedLuminance(activation, x)};
}

// The entries that take part in the certified range, as a chain over entries [first, last].
class Chain {
 public:
  Chain(const Activation& activation, TableTarget target, const std::vector<DesignPoint>& points,
        const std::vector<double>& ideal)
      : activation_(activation), target_(target), points_(points) {
    first_ = points.front().interval;
    const int entries = points.back().interval + 2 - first_;
    problem_.intervals.resize(static_cast<size_t>(entries) - 1);
    for (int i = 0; i < entries; ++i) {
      const double entry = ideal[static_cast<size_t>(first_ + i)];
      const double cap = LargestEntry(target, entry);
      problem_.cap.push_back(cap);
      problem_.preferred.push_back(std::min(entry, cap));
    }
  }

  size_t first() const { return static_cast<size_t>(first_); }

  double WorstError(const std::vector<double>& entries) const {
    double worst = 0;
    for (const DesignPoint& point : points_) {
      const size_t i = static_cast<size_t>(point.interval - first_);
      const double drive =
          DriveOfEntry(target_, std::lerp(entries[i], entries[i + 1], point.weight));
      worst = std::max(worst, std::abs(RelativeError(activation_, drive, point.x)));
    }
    return worst;
  }

  std::vector<double> Preferred() const { return problem_.preferred; }

  std::optional<std::vector<double>> Within(double error) {
    for (auto& interval : problem_.intervals) interval.clear();
    for (const DesignPoint& point : points_) {
      problem_.intervals[static_cast<size_t>(point.interval - first_)].push_back(
          {point.weight, LowestEntry((1 - error) * point.wanted),
           HighestEntry((1 + error) * point.wanted)});
    }
    return SolveChain(problem_);
  }

 private:
  double LowestEntry(double luminance) const {
    if (luminance <= activation_.minimum_luminance) return 0;
    return EntryOfDrive(target_, DriveForLuminance(activation_, luminance));
  }
  double HighestEntry(double luminance) const {
    const double drive = DriveForLuminance(activation_, luminance);
    if (drive >= 1) return std::numeric_limits<double>::infinity();
    return EntryOfDrive(target_, drive);
  }

  const Activation& activation_;
  TableTarget target_;
  const std::vector<DesignPoint>& points_;
  int first_ = 0;
  ChainProblem problem_;
};

}  // namespace

double LargestEntry(TableTarget target, double ideal) {
  if (target == TableTarget::kPps) return 1;
  return std::min(kRoomAboveIdeal * std::max(1.0, ideal), kLargestHalf);
}

void InsertDesigned(const std::vector<double>& designed, size_t first, TableTarget target,
                    std::vector<double>& entries) {
  std::ranges::copy(designed, entries.begin() + static_cast<std::ptrdiff_t>(first));
  for (size_t i = 0; i < first; ++i) entries[i] = std::min(entries[i], designed.front());
  const double white = std::max(EntryOfDrive(target, 1), designed.back());
  for (size_t i = first + designed.size(); i < entries.size(); ++i) entries[i] = white;
}

std::vector<DesignPoint> DesignPoints(const Activation& activation, TableTarget target, int size,
                                      double white_u, double x_from) {
  const double from = PositionOf(target, size, x_from * white_u);
  const double to = PositionOf(target, size, white_u);
  std::vector<DesignPoint> points;
  const int first = static_cast<int>(std::floor(from));
  const int intervals = static_cast<int>(std::ceil(to)) - first;
  const int per_interval = std::max(kPointsPerInterval, kPointsAtLeast / std::max(intervals, 1));
  for (int i = 0; i <= intervals * per_interval; ++i) {
    const double position = first + static_cast<double>(i) / per_interval;
    if (position <= from || position >= to) continue;
    const double x = UAtPosition(target, size, position) / white_u;
    points.push_back(PointAt(activation, size, x, position));
  }
  for (int i = 0; i <= kLogPoints; ++i) {
    const double x = std::pow(x_from, 1 - static_cast<double>(i) / kLogPoints);
    points.push_back(PointAt(activation, size, x, PositionOf(target, size, x * white_u)));
  }
  // Where what is wanted bends, no row of smooth points is dense enough.
  if (const double cutoff = CutoffOf(activation); cutoff > x_from) {
    points.push_back(PointAt(activation, size, cutoff, PositionOf(target, size, cutoff * white_u)));
  }
  std::ranges::sort(points, {}, &DesignPoint::x);
  return points;
}

std::vector<double> IdealEntries(const Activation& activation, TableTarget target, int size,
                                 double white_u) {
  std::vector<double> entries;
  for (int i = 0; i < size; ++i) {
    const double x = std::max(UAtPosition(target, size, i) / white_u, 0.0);
    const double luminance = WantedLuminance(activation, x);
    entries.push_back(EntryOfDrive(target, DriveForLuminance(activation, luminance)));
  }
  return entries;
}

std::vector<double> MinimaxEntries(const Activation& activation, TableTarget target, int size,
                                   double white_u, const std::vector<DesignPoint>& points) {
  std::vector<double> entries = IdealEntries(activation, target, size, white_u);
  Chain chain(activation, target, points, entries);
  InsertDesigned(SmallestWorstError(chain), chain.first(), target, entries);
  return entries;
}

}  // namespace eyebox::fit
