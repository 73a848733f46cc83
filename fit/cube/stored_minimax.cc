#include "fit/cube/stored_minimax.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "fit/cube/bisection.h"
#include "fit/cube/chain.h"
#include "fit/cube/goal.h"
#include "fit/cube/minimax.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kWeights = 256;
// Entries are rounded to these after the design; a bound that is met by a hair must survive it.
constexpr double kHalfRounding = 0x1p-11;
constexpr double kFloatRounding = 0x1p-22;

struct StoredPoint {
  int interval = 0;
  double weight = 0;
  double wanted = 0;
  Channel channel = Channel::kGrey;
};

// Gathers the rendered values at which the error after storage can be largest.
class PointGatherer {
 public:
  PointGatherer(const Activation& activation, TableTarget target, int size, double white_u,
                double x_from, const StorageModel& storage)
      : activation_(activation),
        target_(target),
        size_(size),
        white_u_(white_u),
        x_from_(x_from),
        storage_(storage) {}

  std::vector<StoredPoint> Gather() {
    if (storage_.r11g11b10) {
      AddBufferEdges(Channel::kRed);
      AddBufferEdges(Channel::kBlue);
    } else {
      for (const DesignPoint& point :
           DesignPoints(activation_, target_, size_, white_u_, x_from_)) {
        Add(point.x, Channel::kGrey);
      }
      if (storage_.filter8) AddWeightEdges();
    }
    return std::move(points_);
  }

 private:
  void Add(double x, Channel channel) {
    const StoragePath path(storage_, channel);
    const double position = PositionOf(target_, size_, path.Buffered(x * white_u_));
    const double below = std::clamp(std::floor(position), 0.0, static_cast<double>(size_ - 2));
    points_.push_back({static_cast<int>(below), path.Weight(position - below),
                       WantedLuminance(activation_, x), channel});
  }

  // All rendered values between two numbers that a buffer holds become the lower one.
  void AddBufferEdges(Channel channel) {
    const StoragePath path(storage_, channel);
    const double from = x_from_ * white_u_;
    for (double u = path.Buffered(from); u <= white_u_; u = path.NextBuffered(u)) {
      const double last = std::nextafter(path.NextBuffered(u), 0.0);
      Add(std::max(u, from) / white_u_, channel);
      Add(std::min(last, white_u_) / white_u_, channel);
    }
  }

  void AddWeightEdges() {
    constexpr double kInside = 1e-9;
    const double from = PositionOf(target_, size_, x_from_ * white_u_);
    const double to = PositionOf(target_, size_, white_u_);
    for (int k = static_cast<int>(std::floor(from * kWeights)); k <= to * kWeights; ++k) {
      for (const double side : {-kInside, kInside}) {
        const double position = (k + 0.5 + side) / kWeights;
        if (position <= from || position >= to) continue;
        Add(UAtPosition(target_, size_, position) / white_u_, Channel::kGrey);
      }
    }
  }

  const Activation& activation_;
  TableTarget target_;
  int size_;
  double white_u_;
  double x_from_;
  const StorageModel& storage_;
  std::vector<StoredPoint> points_;
};

class StoredChain {
 public:
  StoredChain(const Activation& activation, TableTarget target, const StorageModel& storage,
              std::vector<StoredPoint> points, const std::vector<double>& preferred)
      : activation_(activation),
        target_(target),
        storage_(storage),
        rounding_(storage.half ? kHalfRounding : kFloatRounding),
        points_(std::move(points)) {
    const auto [least, most] = std::ranges::minmax_element(points_, {}, &StoredPoint::interval);
    first_ = least->interval;
    const int entries = most->interval + 2 - first_;
    problem_.intervals.resize(static_cast<size_t>(entries) - 1);
    for (int i = 0; i < entries; ++i) {
      const double entry = preferred[static_cast<size_t>(first_ + i)];
      problem_.cap.push_back(LargestEntry(target, entry));
      problem_.preferred.push_back(std::min(entry, problem_.cap.back()));
    }
  }

  size_t first() const { return static_cast<size_t>(first_); }
  std::vector<double> Preferred() const { return problem_.preferred; }

  double WorstError(const std::vector<double>& entries) const {
    double worst = 0;
    for (const StoredPoint& point : points_) {
      const StoragePath path(storage_, point.channel);
      const size_t i = static_cast<size_t>(point.interval - first_);
      const double mix =
          std::lerp(path.HeldEntry(entries[i]), path.HeldEntry(entries[i + 1]), point.weight);
      const double drive = path.Shown(DriveOfEntry(target_, path.Buffered(mix)));
      worst = std::max(worst, std::abs(activation_.Luminance(drive) / point.wanted - 1));
    }
    return worst;
  }

  std::optional<std::vector<double>> Within(double error) {
    for (auto& interval : problem_.intervals) interval.clear();
    for (const StoredPoint& point : points_) {
      const StoragePath path(storage_, point.channel);
      problem_.intervals[static_cast<size_t>(point.interval - first_)].push_back(
          {point.weight, LowestMix(path, (1 - error) * point.wanted),
           HighestMix(path, (1 + error) * point.wanted)});
    }
    return SolveChain(problem_);
  }

 private:
  double LowestMix(const StoragePath& path, double luminance) const {
    if (luminance <= activation_.minimum_luminance) return 0;
    const double drive = path.LeastShownFrom(DriveForLuminance(activation_, luminance));
    const double entry = path.LeastBufferedFrom(EntryOfDrive(target_, std::max(drive, 0.0)));
    return entry * (1 + rounding_);
  }
  double HighestMix(const StoragePath& path, double luminance) const {
    const double least = DriveForLuminance(activation_, luminance);
    if (least >= 1) return kInfinity;
    const double drive = path.MostShownTo(least);
    return path.MostBufferedTo(EntryOfDrive(target_, drive)) * (1 - rounding_);
  }

  const Activation& activation_;
  TableTarget target_;
  const StorageModel& storage_;
  double rounding_;
  std::vector<StoredPoint> points_;
  int first_ = 0;
  ChainProblem problem_;
};

}  // namespace

absl::Status CheckStorage(TableTarget target, const StorageModel& storage) {
  const auto refuse = [&](const char* what) {
    return BadInput("storage model", NameOf(storage) + ": " + what,
                    "leave it out for target " + std::string(NameOf(target)));
  };
  if (storage.r11g11b10 && target != TableTarget::kHdrp) {
    return refuse("only HDRP has R11G11B10 colour buffers");
  }
  const bool is_8bit_file = target == TableTarget::kPps;
  if (storage.half && (is_8bit_file || target == TableTarget::kPtb)) {
    return refuse("such a table is not held in half floats");
  }
  if (storage.filter8 && target == TableTarget::kPtb) {
    return refuse("such a table is not interpolated");
  }
  return absl::OkStatus();
}

std::vector<double> StoredMinimaxEntries(const Activation& activation, TableTarget target,
                                         double white_u, double x_from, const StorageModel& storage,
                                         std::vector<double> preferred) {
  const int size = static_cast<int>(preferred.size());
  PointGatherer gatherer(activation, target, size, white_u, x_from, storage);
  StoredChain chain(activation, target, storage, gatherer.Gather(), preferred);
  InsertDesigned(SmallestWorstError(chain), chain.first(), target, preferred);
  const StoragePath path(storage, Channel::kGrey);
  for (double& entry : preferred) entry = path.HeldEntry(entry);
  return preferred;
}

}  // namespace eyebox::fit
