#include "optics/reduce/clip_stack.h"

#include <array>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kFewestSigmas = 3;

// The extremes of one pixel: two highest, then two lowest, the outermost first.
using Candidates = std::array<double, 4>;

struct Kept {
  double sum_dn = 0;
  int frames = 0;
  int saturated = 0;  // among those left out
};

// `trimmed` of each side are left out of the centre, and may be left out of the mean.
Kept Clip(double sum_dn, int frames, int trimmed, const Candidates& candidates,
          const NoiseModel& noise, double sigmas, double saturation_dn) {
  double between_dn = sum_dn;
  for (int k = 0; k < trimmed; ++k) between_dn -= candidates[k] + candidates[2 + k];
  const int between = frames - 2 * trimmed;
  const double centre_dn = between_dn / between;
  const double variance = noise.MeanVariance(centre_dn - noise.bias_dn, 1) * (1 + 1.0 / between);
  const double reach_dn = sigmas * std::sqrt(variance);
  Kept kept{sum_dn, frames, 0};
  for (int k = 0; k < trimmed; ++k) {
    for (const double dn : {candidates[k], candidates[2 + k]}) {
      if (std::abs(dn - centre_dn) <= reach_dn) continue;
      kept.sum_dn -= dn;
      --kept.frames;
      kept.saturated += dn >= saturation_dn ? 1 : 0;
    }
  }
  return kept;
}

}  // namespace

absl::StatusOr<Stack> ClipStack(Stack stack, const NoiseModel& noise, double sigmas) {
  if (!(sigmas >= kFewestSigmas)) {
    return BadInput("clip", absl::StrCat(sigmas, " sigmas"),
                    absl::StrCat("give ", kFewestSigmas, " or more, or good frames are lost"));
  }
  if (!stack.extremes) {
    return BadInput(absl::StrCat("stack of ", Describe(stack.setting)), "it has no extremes",
                    "stack the frames with keep_extremes");
  }
  const Extremes extremes = *std::exchange(stack.extremes, std::nullopt);
  const int trimmed = stack.frames >= 5 ? 2 : stack.frames >= 3 ? 1 : 0;
  if (trimmed == 0) return stack;
  stack.rejected_count = Image<uint8_t>(stack.size());
  const double saturation_dn = stack.range.SaturationDn();
  const auto mean = stack.mean_dn.pixels();
  for (size_t i = 0; i < mean.size(); ++i) {
    const Candidates candidates = {static_cast<double>(extremes.highest.pixels()[i]),
                                   static_cast<double>(extremes.second_highest.pixels()[i]),
                                   static_cast<double>(extremes.lowest.pixels()[i]),
                                   static_cast<double>(extremes.second_lowest.pixels()[i])};
    // The mean is rounded to single precision; a sum of counts is a whole number.
    const double sum_dn = std::round(static_cast<double>(mean[i]) * stack.frames);
    const Kept kept = Clip(sum_dn, stack.frames, trimmed, candidates, noise, sigmas, saturation_dn);
    if (kept.frames == stack.frames) continue;
    mean[i] = static_cast<float>(kept.sum_dn / kept.frames);
    stack.rejected_count.pixels()[i] = static_cast<uint8_t>(stack.frames - kept.frames);
    uint8_t& saturated = stack.saturated_count.pixels()[i];
    saturated = static_cast<uint8_t>(saturated - kept.saturated);
  }
  return stack;
}

}  // namespace eyebox::optics
