#include "service/preflight/refresh.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "capture/photodiode/exposure_check.h"

namespace eyebox::service {
namespace {

constexpr std::chrono::milliseconds kBlockTimeout(2000);
constexpr double kSecondRate = 0.791;  // of the first
constexpr char kConnect[] =
    "connect a photodiode and name it: photodiode_uri in the rig file, or --photodiode";

absl::StatusOr<capture::StrobeMeasurement> MeasureAt(capture::Photodiode& photodiode,
                                                     double sample_rate_hz, double record_s) {
  EYEBOX_RETURN_IF_ERROR(photodiode.Stop());
  EYEBOX_RETURN_IF_ERROR(photodiode.Configure({.sample_rate_hz = sample_rate_hz}).status());
  EYEBOX_RETURN_IF_ERROR(photodiode.Start());
  std::vector<capture::PhotodiodeSample> samples;
  const auto span_ns = static_cast<int64_t>(record_s * 1e9);
  while (samples.empty() || samples.back().monotonic_ns - samples.front().monotonic_ns < span_ns) {
    EYEBOX_ASSIGN_OR_RETURN(const capture::SampleBlock block, photodiode.Read(kBlockTimeout));
    samples.insert(samples.end(), block.samples.begin(), block.samples.end());
  }
  EYEBOX_RETURN_IF_ERROR(photodiode.Stop());
  return capture::MeasureStrobe(samples, {.minimum_counts = photodiode.Info().minimum_counts,
                                          .maximum_counts = photodiode.Info().maximum_counts});
}

// What one exposure adds to the check.
void Add(double exposure_s, const capture::ExposureCheck& fit, Check& check) {
  check.figures.push_back(
      {absl::StrFormat("periods_of_%g_s", exposure_s), fit.periods, fit.periods_sigma, "1"});
  if (fit.whole) return;
  check.figures.push_back(
      {absl::StrFormat("bound_of_%g_s", exposure_s), fit.bound_relative, 0, "1"});
  absl::StrAppend(
      &check.cause, check.cause.empty() ? "" : "; ",
      absl::StrFormat("%g s is %.3f refresh periods, so its light is uncertain by up "
                      "to %.3g %% (bound 1/n: %.3g %%)",
                      exposure_s, fit.periods, 100 * fit.worst_relative, 100 * fit.bound_relative));
  absl::StrAppend(&check.remedy,
                  check.remedy.empty() ? "expose for a whole number of periods: " : ", ",
                  absl::StrFormat("%.7g s instead of %g s", fit.nearest_whole_s, exposure_s));
}

}  // namespace

absl::StatusOr<capture::StrobeMeasurement> MeasureRefresh(capture::Photodiode& photodiode,
                                                          const RefreshOptions& options) {
  const double rate_hz = std::min(options.sample_rate_hz, photodiode.Info().sample_rate_max_hz);
  EYEBOX_ASSIGN_OR_RETURN(const auto first, MeasureAt(photodiode, rate_hz, options.record_s));
  EYEBOX_ASSIGN_OR_RETURN(const auto second,
                          MeasureAt(photodiode, kSecondRate * rate_hz, options.record_s));
  if (!first.strobed && !second.strobed) return first;
  EYEBOX_RETURN_IF_ERROR(capture::CheckNotAliased(first, second));
  return first.period_sigma_s <= second.period_sigma_s ? first : second;
}

Check CheckRefresh(const std::optional<absl::StatusOr<capture::StrobeMeasurement>>& strobe,
                   const RefreshOptions& options) {
  Check check = {.name = "refresh",
                 .wanted = absl::StrFormat("period known within %g %%, or a steady display",
                                           100 * options.largest_period_sigma)};
  if (!strobe) {
    return std::move(check).Skipped("no photodiode: period and duty of the display are not known",
                                    kConnect);
  }
  if (!strobe->ok()) {
    return std::move(check).Failed(
        "the photodiode gives no period: " + std::string(strobe->status().message()),
        "aim it at a steady, bright full field, below clipping, and measure again");
  }
  const capture::StrobeMeasurement& measured = **strobe;
  check.measured = Figure{"period", measured.period_s, measured.period_sigma_s, "s"};
  check.threshold = options.largest_period_sigma * measured.period_s;
  check.figures = {{"duty", measured.duty, measured.duty_sigma, "1"},
                   {"depth", measured.depth, 0, "1"}};
  if (!measured.strobed || measured.period_sigma_s <= check.threshold) return check;
  return std::move(check).Failed(absl::StrFormat("the period is known within %.2g %% only",
                                                 100 * measured.period_sigma_s / measured.period_s),
                                 "show a brighter field to the photodiode, or sample faster");
}

Check CheckWholePeriods(const std::optional<absl::StatusOr<capture::StrobeMeasurement>>& strobe,
                        std::span<const double> exposures_s, double tolerance) {
  Check check = {.name = "whole_periods",
                 .wanted = absl::StrFormat("every exposure a whole number of refresh periods "
                                           "(within %g %% of its light)",
                                           100 * tolerance),
                 .threshold = tolerance};
  if (!strobe || !strobe->ok()) {
    return std::move(check).Skipped(
        "the refresh period is not known: an exposure of n periods may "
        "be wrong by up to 1/n",
        kConnect);
  }
  double worst = 0;
  for (const double exposure_s : exposures_s) {
    const auto fit = capture::CheckExposure(exposure_s, **strobe, tolerance);
    if (!fit.ok()) {
      return std::move(check).Failed(std::string(fit.status().message()),
                                     "give exposures in s, above 0");
    }
    worst = std::max(worst, fit->worst_relative);
    if ((*strobe)->strobed) Add(exposure_s, *fit, check);
  }
  check.measured = Figure{"worst_relative", worst, 0, "1"};
  if (!check.cause.empty()) check.verdict = Verdict::kFailed;
  return check;
}

}  // namespace eyebox::service
