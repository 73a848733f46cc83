#include "service/preflight/stale_frames.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

double Mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Spread(std::span<const double> values) {
  const double mean = Mean(values);
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value - mean));
  return largest;
}

struct Staleness {
  bool distinct = false;   // the two settled levels are
  int frames = 0;          // up to the last that is not of the new exposure
  double worst_share = 0;  // of the step that such a frame lies off the new level
  double noise = 0;        // of the settled frames, share of the step
};

Staleness Look(const ExposureChange& change, const StaleOptions& options) {
  Staleness found;
  if (change.old_means_dn.empty() || change.new_means_dn.empty()) return found;
  const double level_dn = Mean(change.new_means_dn);
  const double step_dn = std::abs(Mean(change.old_means_dn) - level_dn);
  const double noise_dn = std::max(Spread(change.old_means_dn), Spread(change.new_means_dn));
  found.distinct = step_dn > 0 && step_dn > 5 * noise_dn && step_dn > 0.05 * std::abs(level_dn);
  if (!found.distinct) return found;
  found.noise = noise_dn / step_dn;
  const double limit = std::max(options.tolerance, 5 * found.noise);
  for (size_t k = 0; k < change.first_means_dn.size(); ++k) {
    const double share = std::abs(change.first_means_dn[k] - level_dn) / step_dn;
    if (share > limit) found.frames = static_cast<int>(k) + 1;
    found.worst_share = std::max(found.worst_share, share);
  }
  return found;
}

}  // namespace

Check CheckStaleFrames(std::span<const ExposureChange> changes, const StaleOptions& options) {
  Check check = {.name = "stale_frames",
                 .wanted = "0 frames of the old exposure after a change, either way"};
  int stale = 0;
  double worst_share = 0;
  size_t looked_at = 0;
  for (const ExposureChange& change : changes) {
    const Staleness found = Look(change, options);
    if (!found.distinct || change.first_means_dn.empty()) continue;
    ++looked_at;
    stale = std::max(stale, found.frames);
    worst_share = std::max(worst_share, found.worst_share);
    check.figures.push_back({absl::StrFormat("frames_after_%g_s", change.old_exposure_s),
                             static_cast<double>(found.frames), 0, "1"});
  }
  if (looked_at == 0 || looked_at < changes.size()) {
    return std::move(check).Skipped("two exposures did not give two levels of light",
                                    "see exposure_ladder; then run the preflight again");
  }
  check.measured = Figure{"stale_frames", static_cast<double>(stale), 0, "1"};
  check.figures.push_back({"largest_share_of_step", worst_share, 0, "1"});
  if (stale == 0) return check;
  return std::move(check).Failed(
      absl::StrFormat("stale frames: the first %d after a change of exposure are not of the new "
                      "exposure",
                      stale),
      absl::StrFormat("drop %d frames after every change, whatever their metadata say; check that "
                      "the trigger comes after the exposure is written",
                      stale));
}

}  // namespace eyebox::service
