#include "service/preflight/exposure_ladder.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

// Below this the signal does not follow the exposure at all.
constexpr double kSlopeOfAutomatic = 0.2;

struct LogLine {
  double slope = 0;
  double slope_sigma = 0;  // scaled up where the residuals exceed the rungs' own uncertainties
  double residual_rms = 0;
  double largest_residual = 0;
  double largest_rung_sigma = 0;
};

std::vector<LadderRung> Usable(std::span<const LadderRung> rungs) {
  std::vector<LadderRung> usable;
  for (const LadderRung& rung : rungs) {
    const bool lit = rung.signal_dn > 3 * rung.sigma_dn && std::isfinite(rung.signal_dn);
    if (lit && rung.exposure_s > 0 && !rung.saturated) usable.push_back(rung);
  }
  std::ranges::sort(usable, {}, &LadderRung::exposure_s);
  return usable;
}

double RelativeSigma(const LadderRung& rung, const LadderOptions& options) {
  return std::hypot(rung.sigma_dn / rung.signal_dn, options.rung_floor);
}

// Weighted least squares of ln signal on ln exposure.
LogLine FitLine(std::span<const LadderRung> rungs, const LadderOptions& options) {
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (const LadderRung& rung : rungs) {
    const double weight = 1 / std::pow(RelativeSigma(rung, options), 2);
    const double x = std::log(rung.exposure_s);
    const double y = std::log(rung.signal_dn);
    w += weight, wx += weight * x, wy += weight * y;
    wxx += weight * x * x, wxy += weight * x * y;
  }
  const double determinant = w * wxx - wx * wx;
  LogLine line;
  line.slope = (w * wxy - wx * wy) / determinant;
  const double offset = (wy - line.slope * wx) / w;
  double chi_square = 0;
  double sum = 0;
  for (const LadderRung& rung : rungs) {
    const double sigma = RelativeSigma(rung, options);
    const double residual =
        std::log(rung.signal_dn) - offset - line.slope * std::log(rung.exposure_s);
    chi_square += std::pow(residual / sigma, 2);
    sum += residual * residual;
    line.largest_residual = std::max(line.largest_residual, std::abs(residual));
    line.largest_rung_sigma = std::max(line.largest_rung_sigma, sigma);
  }
  const auto count = static_cast<double>(rungs.size());
  line.residual_rms = std::sqrt(sum / count);
  line.slope_sigma = std::sqrt(w / determinant * std::max(1.0, chi_square / (count - 2)));
  return line;
}

Check Unsteady(Check check, double relative) {
  return std::move(check).Failed(
      absl::StrFormat("the light is not steady: frames of one exposure differ by %.3g %%",
                      100 * relative),
      "the display flashes or dims: connect a photodiode (photodiode_uri), so that exposures "
      "become whole numbers of refresh periods, and keep the headset awake");
}

// Frames of one exposure differ by far more than their pixels' noise.
bool IsUnsteady(const LadderRung& rung, const LadderOptions& options) {
  return rung.sigma_dn > options.largest_residual * std::abs(rung.signal_dn) &&
         rung.sigma_dn > 10 * rung.pixel_sigma_dn;
}

// Why there is nothing to fit.
Check Unusable(Check check, std::span<const LadderRung> rungs, size_t usable, double decades,
               const LadderOptions& options) {
  for (const LadderRung& rung : rungs) {
    if (IsUnsteady(rung, options)) {
      return Unsteady(std::move(check), rung.sigma_dn / std::abs(rung.signal_dn));
    }
  }
  const auto saturated = static_cast<size_t>(std::ranges::count_if(rungs, &LadderRung::saturated));
  if (saturated > 0 && saturated == rungs.size()) {
    return std::move(check).Failed("every exposure is saturated",
                                   "show a darker field, close the aperture or add a filter");
  }
  if (usable == 0) {
    return std::move(check).Failed(
        "no exposure is brighter than its dark",
        "show a full field during the light frames and cover the lens during the dark ones");
  }
  return std::move(check).Failed(
      absl::StrFormat("only %d of %d exposures, over %.2f decades, have signal and are not "
                      "saturated",
                      usable, rungs.size(), decades),
      "choose a field bright enough for the shortest and dark enough for the longest exposure");
}

Check Judge(Check check, const LogLine& line, const LadderOptions& options) {
  if (line.slope < kSlopeOfAutomatic) {
    return std::move(check).Failed(
        "automatic exposure or gain is at work: the signal does not follow the exposure",
        "switch automatic exposure and gain off in the camera; a read-back of 'off' was not true");
  }
  if (line.largest_rung_sigma > options.largest_residual) {
    return Unsteady(std::move(check), line.largest_rung_sigma);
  }
  if (std::abs(line.slope - 1) > check.threshold || std::abs(line.slope - 1) > 0.05) {
    return std::move(check).Failed(
        absl::StrFormat(
            "the counts are no measure of light: they grow as the exposure to the power "
            "%.2f, so a gamma or another tone curve is applied to them",
            line.slope),
        "switch gamma, lookup table, contrast and HDR modes off, or set gamma to 1");
  }
  if (line.largest_residual > options.largest_residual) {
    return std::move(check).Failed(
        absl::StrFormat("the response is bent: an exposure lies %.2g %% off the line",
                        100 * line.largest_residual),
        "switch tone curves off; keep the longest exposure below saturation and stray light out");
  }
  if (line.slope_sigma > options.largest_slope_sigma) {
    return std::move(check).Failed(
        absl::StrFormat("the slope is known to %.2g only, which proves nothing", line.slope_sigma),
        "take more frames, or a brighter and steadier field");
  }
  return check;
}

}  // namespace

Check CheckExposureLadder(std::span<const LadderRung> rungs, const LadderOptions& options) {
  Check check = {.name = "exposure_ladder", .wanted = "slope 1 of log signal over log exposure"};
  const std::vector<LadderRung> usable = Usable(rungs);
  const double decades =
      usable.empty() ? 0 : std::log10(usable.back().exposure_s / usable.front().exposure_s);
  check.figures = {{"rungs", static_cast<double>(usable.size()), 0, "1"},
                   {"decades", decades, 0, "1"}};
  const bool enough = static_cast<int>(usable.size()) >= std::max(options.least_rungs, 3);
  if (!enough || decades < options.least_decades) {
    return Unusable(std::move(check), rungs, usable.size(), decades, options);
  }
  const LogLine line = FitLine(usable, options);
  check.threshold = 3 * line.slope_sigma + options.slope_tolerance;
  check.measured = Figure{"slope", line.slope, line.slope_sigma, "1"};
  check.wanted = absl::StrFormat("1 within %.2g", check.threshold);
  check.figures.push_back({"residual_rms", line.residual_rms, 0, "1"});
  return Judge(std::move(check), line, options);
}

}  // namespace eyebox::service
