#include "service/preflight/ladder_range.h"

#include <algorithm>
#include <cmath>

#include "capture/base/status.h"
#include "service/preflight/frame_figures.h"

namespace eyebox::service {
namespace {

constexpr std::array kDrives = {1.0, 0.5, 0.35, 0.25, 0.18, 0.12};
constexpr double kBrightShare = 0.999;  // of the pixels; hot ones do not decide
constexpr double kFill = 0.8;           // of full scale, that the bright ones may reach
constexpr int kFrames = 3;              // a flash of the display may miss one
constexpr double kSteadyStartS = 1e-4;
const double kSpan = std::exp2(kLadderRungs - 1);

// Whether the camera can take this exposure and almost no pixel gets near saturation.
absl::StatusOr<bool> Fits(FrameTaker& taker, double exposure_s) {
  EYEBOX_ASSIGN_OR_RETURN(const auto frames, taker.TakeSettled(exposure_s, kFrames));
  const double limit_dn = kFill * (std::exp2(taker.info().significant_bits) - 1);
  return std::ranges::all_of(
      frames, [&](const Counts& frame) { return Quantile(frame, kBrightShare) <= limit_dn; });
}

LadderRange LadderFrom(double drive, double shortest_s) {
  LadderRange range = {.drive = drive};
  for (size_t i = 0; i < kLadderRungs; ++i) {
    range.exposures_s[i] = shortest_s * std::exp2(static_cast<double>(i));
  }
  return range;
}

}  // namespace

absl::StatusOr<LadderRange> ChooseLadder(FrameTaker& taker, double period_s, double longest_s) {
  const double start_s = std::max(taker.info().exposure_min_s, kSteadyStartS);
  // The first whole number of periods that the camera can expose for.
  const double least_s = period_s > 0 ? std::ceil(start_s / period_s) * period_s
                                      : std::max(taker.info().exposure_min_s, 1e-9);
  const double unit_s = period_s > 0 ? least_s : start_s;
  const double most_s = std::min(std::max(longest_s, kSpan * least_s), taker.info().exposure_max_s);
  for (const double drive : kDrives) {
    EYEBOX_RETURN_IF_ERROR(taker.ShowGrey(drive));
    double fitting_s = 0;
    for (double exposure_s = unit_s; exposure_s <= most_s; exposure_s *= 2) {
      EYEBOX_ASSIGN_OR_RETURN(const bool fits, Fits(taker, exposure_s));
      if (!fits) break;
      fitting_s = exposure_s;
    }
    if (fitting_s / kSpan >= least_s * (1 - 1e-9)) return LadderFrom(drive, fitting_s / kSpan);
  }
  return LadderFrom(kDrives.back(), least_s);
}

}  // namespace eyebox::service
