#include "optics/photometry/fit_luminance_scale.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "optics/uniformity/chi_square.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestReadings = 3;
constexpr double kWholeRangeWithin = 0.1;  // least over largest luminance of a range worth a test

absl::Status Check(std::span<const ScaleReading> readings, const LuminanceScaleOptions& options) {
  if (readings.size() < kFewestReadings) {
    return BadInput("luminance scale", absl::StrCat(readings.size(), " readings"),
                    "give at least 3 known luminances, better 6 over the whole range");
  }
  if (!(options.meter_relative_sigma >= 0 && options.meter_relative_sigma < 1)) {
    return BadInput("meter", absl::StrCat("relative sigma ", options.meter_relative_sigma),
                    "give its relative standard uncertainty, at least 0 and below 1");
  }
  for (size_t i = 0; i < readings.size(); ++i) {
    const ScaleReading& r = readings[i];
    const std::string where = absl::StrCat("reading ", i + 1);
    if (!std::isfinite(r.luminance_cd_m2 + r.luminance_sigma + r.reading + r.reading_sigma)) {
      return BadInput(where, "is not finite", "give numbers");
    }
    if (r.luminance_cd_m2 < 0 || r.luminance_sigma < 0 || r.reading_sigma < 0) {
      return BadInput(where, "a luminance or sigma below 0", "give values of at least 0");
    }
    if (r.luminance_sigma == 0 && r.reading_sigma == 0) {
      return BadInput(where, "has no uncertainty",
                      "give the sigma of the luminance or the reading");
    }
  }
  const auto [low, high] = std::ranges::minmax(readings, {}, &ScaleReading::luminance_cd_m2);
  if (!(high.luminance_cd_m2 > low.luminance_cd_m2)) {
    return BadInput("luminance scale", "all readings are of one luminance",
                    "measure several luminances");
  }
  return absl::OkStatus();
}

// Sums of a weighted line.
struct Sums {
  double w = 0, x = 0, y = 0, xx = 0, xy = 0;
};

Sums SumUp(std::span<const ScaleReading> readings, double slope) {
  Sums sums;
  for (const ScaleReading& r : readings) {
    const double weight = 1 / (r.luminance_sigma * r.luminance_sigma +
                               slope * slope * r.reading_sigma * r.reading_sigma);
    sums.w += weight;
    sums.x += weight * r.reading;
    sums.y += weight * r.luminance_cd_m2;
    sums.xx += weight * r.reading * r.reading;
    sums.xy += weight * r.reading * r.luminance_cd_m2;
  }
  return sums;
}

// The weights depend on the slope, weakly: a few rounds settle it.
template <typename Slope>
double SettledSlope(std::span<const ScaleReading> readings, double slope, Slope slope_of) {
  for (int round = 0; round < 50; ++round) {
    const double next = slope_of(SumUp(readings, slope));
    const bool settled = std::abs(next - slope) <= 1e-14 * std::abs(next);
    slope = next;
    if (settled) break;
  }
  return slope;
}

void FitIntercept(std::span<const ScaleReading> readings, double slope, double widening,
                  LuminanceScaleFit& fit) {
  const auto slope_of = [](const Sums& s) {
    return (s.w * s.xy - s.x * s.y) / (s.w * s.xx - s.x * s.x);
  };
  fit.slope_with_intercept = SettledSlope(readings, slope, slope_of);
  const Sums s = SumUp(readings, fit.slope_with_intercept);
  const double determinant = s.w * s.xx - s.x * s.x;
  fit.intercept_cd_m2 = (s.xx * s.y - s.x * s.xy) / determinant;
  fit.intercept_sigma_cd_m2 = widening * std::sqrt(s.xx / determinant);
  fit.slope_with_intercept_sigma = widening * std::sqrt(s.w / determinant);
  const double pull = fit.intercept_cd_m2 / fit.intercept_sigma_cd_m2;
  fit.intercept_p_value = std::erfc(std::abs(pull) / std::sqrt(2.0));
}

double Chi2(std::span<const ScaleReading> readings, double slope, double intercept) {
  double chi2 = 0;
  for (const ScaleReading& r : readings) {
    chi2 +=
        std::pow(r.luminance_cd_m2 - slope * r.reading - intercept, 2) /
        (r.luminance_sigma * r.luminance_sigma + slope * slope * r.reading_sigma * r.reading_sigma);
  }
  return chi2;
}

void Judge(std::span<const ScaleReading> readings, const LuminanceScaleOptions& options,
           LuminanceScaleFit& fit) {
  if (fit.intercept_p_value < options.intercept_probability) {
    fit.reasons.push_back(
        absl::StrFormat("the line does not go through the origin: %.3g +- %.2g cd/m2 at 0 DN/s (p "
                        "= %.2g): look for "
                        "stray light, a wrong dark or a clipped black level",
                        fit.intercept_cd_m2, fit.intercept_sigma_cd_m2, fit.intercept_p_value));
  }
  const auto [low, high] = std::ranges::minmax(readings, {}, &ScaleReading::luminance_cd_m2);
  if (low.luminance_cd_m2 > kWholeRangeWithin * high.luminance_cd_m2) {
    fit.warnings.push_back(
        "the known luminances span less than a factor of 10: an intercept would hardly be seen");
  }
  if (options.meter_relative_sigma == 0) {
    fit.warnings.push_back(
        "the meter's calibration uncertainty was not given: the scale's is that of the fit alone");
  }
  fit.accepted = fit.reasons.empty();
}

}  // namespace

absl::StatusOr<LuminanceScaleFit> FitLuminanceScale(std::span<const ScaleReading> readings,
                                                    const LuminanceScaleOptions& options) {
  EYEBOX_RETURN_IF_ERROR(Check(readings, options));
  const auto brightest = std::ranges::max(readings, {}, &ScaleReading::luminance_cd_m2);
  const double start = brightest.luminance_cd_m2 / brightest.reading;
  if (!(start > 0)) {
    return BadInput("luminance scale", "the brightest light has a reading that is not above 0",
                    "subtract the dark, and give luminances and readings in the same order");
  }
  const auto slope_of = [](const Sums& s) { return s.xy / s.xx; };
  const double slope = SettledSlope(readings, start, slope_of);
  if (!(slope > 0)) {
    return BadInput("luminance scale", "readings do not rise with luminance", "check their order");
  }
  LuminanceScaleFit fit;
  const double freedom = static_cast<double>(readings.size()) - 1;
  const double chi2 = Chi2(readings, slope, 0);
  fit.reduced_chi2 = chi2 / freedom;
  fit.chi2_p_value = ChiSquareSurvival(chi2, freedom);
  // The intercept is tested by the scatter about its own line, or it would hide itself.
  FitIntercept(readings, slope, 1, fit);
  const double chi2_line = Chi2(readings, fit.slope_with_intercept, fit.intercept_cd_m2);
  double widening = 1;
  if (ChiSquareSurvival(chi2_line, freedom - 1) < options.scatter_probability) {
    widening = std::sqrt(chi2_line / (freedom - 1));
    fit.warnings.push_back(absl::StrFormat(
        "readings scatter %.2g times as much as their sigmas say: uncertainties were widened by it",
        widening));
    FitIntercept(readings, slope, widening, fit);
  }
  fit.fit_relative_sigma = widening / std::sqrt(SumUp(readings, slope).xx) / slope;
  fit.per_unit = {slope, std::hypot(fit.fit_relative_sigma, options.meter_relative_sigma)};
  for (const ScaleReading& r : readings) fit.fitted_cd_m2.push_back(slope * r.reading);
  Judge(readings, options, fit);
  return fit;
}

}  // namespace eyebox::optics
