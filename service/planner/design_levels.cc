#include "service/planner/design_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/base/status.h"
#include "service/planner/measure_setting.h"
#include "service/planner/predict_error.h"

namespace eyebox::service {
namespace {

constexpr int kCandidateDrives = 33;
// A fit with as many parameters as a gamma with cutoff needs so many different drives.
constexpr size_t kFewestLevels = 5;
constexpr double kNegligibleShare = 0.005;

struct Candidates {
  std::vector<fit::LevelCandidate> levels;
  std::vector<std::pair<int, size_t>> places;  // drive and exposure of each
};

Candidates OfferedBy(const Pilot& pilot, const Costs& costs, int calibration_frames) {
  Candidates candidates;
  for (int d = 0; d < kCandidateDrives; ++d) {
    const double drive = d / (kCandidateDrives - 1.0);
    const double luminance = pilot.activation.activation.Luminance(drive);
    for (size_t k = 0; k < pilot.exposures_s.size(); ++k) {
      std::vector<int> frames(pilot.exposures_s.size(), 0);
      frames[k] = 1;
      const double variance = LuminanceVariance(pilot, luminance, pilot.response_at_reference,
                                                frames, calibration_frames);
      if (!std::isfinite(variance)) continue;
      candidates.levels.push_back(
          {drive, std::sqrt(variance / static_cast<double>(pilot.reference_pixels)),
           pilot.exposures_s[k] + costs.frame_s});
      candidates.places.emplace_back(d, k);
    }
  }
  return candidates;
}

// Seconds of each drive and exposure, [drives][exposures], in shares of the whole. A share between
// two drives of the grid is split among them: it goes to the larger one.
std::vector<std::vector<double>> SharesByDrive(const Candidates& candidates,
                                               const std::vector<double>& shares,
                                               size_t exposures) {
  std::vector<std::vector<double>> by_drive(kCandidateDrives, std::vector<double>(exposures, 0));
  for (size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] < kNegligibleShare) continue;
    by_drive[candidates.places[i].first][candidates.places[i].second] = shares[i];
  }
  const auto sum = [](const std::vector<double>& of) {
    double total = 0;
    for (const double share : of) total += share;
    return total;
  };
  for (size_t d = 0; d + 1 < by_drive.size(); ++d) {
    const double here = sum(by_drive[d]);
    const double next = sum(by_drive[d + 1]);
    if (here == 0 || next == 0) continue;
    auto& kept = here > next ? by_drive[d] : by_drive[d + 1];
    auto& given = here > next ? by_drive[d + 1] : by_drive[d];
    for (size_t k = 0; k < exposures; ++k) kept[k] += std::exchange(given[k], 0);
  }
  return by_drive;
}

// Frames for the shares of `seconds`, but the longest exposure of a level at least once.
std::vector<int> FramesFor(const std::vector<double>& shares, double seconds, const Pilot& pilot,
                           const Costs& costs) {
  std::vector<int> frames;
  int count = 0;
  size_t largest = 0;
  for (size_t k = 0; k < shares.size(); ++k) {
    const double wanted = shares[k] * seconds / (pilot.exposures_s[k] + costs.frame_s);
    frames.push_back(static_cast<int>(std::lround(wanted)));
    count += frames.back();
    if (shares[k] > shares[largest]) largest = k;
  }
  if (count == 0) frames[largest] = 1;
  return frames;
}

size_t ExposureFor(const Candidates& candidates, int drive) {
  size_t longest = 0;
  for (const auto& [d, k] : candidates.places) {
    if (d == drive) longest = std::max(longest, k);
  }
  return longest;
}

void AddLevel(const Candidates& candidates, int drive, size_t exposures,
              std::vector<LevelFrames>& levels) {
  LevelFrames level{drive / (kCandidateDrives - 1.0), std::vector<int>(exposures, 0)};
  level.frames[ExposureFor(candidates, drive)] = 1;
  const auto place = std::ranges::lower_bound(levels, level.drive, {}, &LevelFrames::drive);
  levels.insert(place, std::move(level));
}

// White is what the field is measured with; a fit wants a few drives whatever the design says.
void Complete(const Candidates& candidates, size_t exposures, std::vector<LevelFrames>& levels) {
  if (levels.empty() || levels.back().drive < 1) {
    AddLevel(candidates, kCandidateDrives - 1, exposures, levels);
  }
  while (levels.size() < kFewestLevels) {
    double widest = levels.front().drive;
    double middle = 0;
    for (size_t i = 1; i < levels.size(); ++i) {
      const double gap = levels[i].drive - levels[i - 1].drive;
      if (gap <= widest) continue;
      widest = gap;
      middle = 0.5 * (levels[i].drive + levels[i - 1].drive);
    }
    AddLevel(candidates, static_cast<int>(std::lround(middle * (kCandidateDrives - 1))), exposures,
             levels);
  }
}

}  // namespace

double LevelSeconds(const std::vector<LevelFrames>& levels, const std::vector<double>& exposures_s,
                    const Costs& costs) {
  double seconds = 0;
  for (const LevelFrames& level : levels) {
    seconds += costs.stimulus_s;
    for (size_t k = 0; k < exposures_s.size(); ++k) {
      seconds += level.frames[k] * (exposures_s[k] + costs.frame_s);
    }
  }
  return seconds;
}

absl::StatusOr<DesignedLevels> DesignLevels(const Pilot& pilot, const Need& need,
                                            fit::ErrorAtU error, double seconds, const Costs& costs,
                                            int calibration_frames) {
  const Candidates candidates = OfferedBy(pilot, costs, calibration_frames);
  EYEBOX_ASSIGN_OR_RETURN(
      const fit::LevelDesign design,
      fit::OptimalLevels(pilot.activation, error, candidates.levels, LooksAt(need)));
  const size_t exposures = pilot.exposures_s.size();
  const auto by_drive = SharesByDrive(candidates, design.shares, exposures);
  const auto used = std::ranges::count_if(by_drive, [](const auto& shares) {
    return std::ranges::any_of(shares, [](double share) { return share > 0; });
  });
  const double frame_seconds = seconds - costs.stimulus_s * static_cast<double>(used);
  if (!(frame_seconds > 0)) {
    return Rejected("level design", "the time does not suffice for its stimuli", "allow more time");
  }
  DesignedLevels designed{{}, design.efficiency};
  for (int d = 0; d < kCandidateDrives; ++d) {
    const std::vector<double>& shares = by_drive[static_cast<size_t>(d)];
    if (std::ranges::all_of(shares, [](double share) { return share == 0; })) continue;
    designed.levels.push_back(
        {d / (kCandidateDrives - 1.0), FramesFor(shares, frame_seconds, pilot, costs)});
  }
  Complete(candidates, exposures, designed.levels);
  return designed;
}

}  // namespace eyebox::service
