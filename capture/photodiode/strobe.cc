#include "capture/photodiode/strobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "capture/base/status.h"
#include "capture/photodiode/strobe_fit.h"

namespace eyebox::capture {
namespace {

constexpr size_t kMinimumSamples = 16;
constexpr char kWhere[] = "strobe measurement";

absl::Status CheckSamples(std::span<const PhotodiodeSample> samples, const StrobeOptions& options) {
  if (samples.size() < kMinimumSamples) {
    return BadInput(kWhere, "got " + std::to_string(samples.size()) + " samples",
                    "give " + std::to_string(kMinimumSamples) + " or more");
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    const std::string where = std::string(kWhere) + ", sample " + std::to_string(i);
    if (i > 0 && samples[i].monotonic_ns <= samples[i - 1].monotonic_ns) {
      return BadInput(where, "is not later than the one before", "give them in order of time");
    }
    const int32_t counts = samples[i].counts;
    if (counts <= options.minimum_counts || counts >= options.maximum_counts) {
      return Rejected(where, "is clipped at " + std::to_string(counts) + " counts",
                      "change gain or offset of the amplifier, so that light and dark both fit");
    }
  }
  return absl::OkStatus();
}

// Middle of the times at 0; mean and linear trend subtracted.
StrobeRecord RecordOf(std::span<const PhotodiodeSample> samples) {
  StrobeRecord record;
  const int64_t first_ns = samples.front().monotonic_ns;
  record.span_s = static_cast<double>(samples.back().monotonic_ns - first_ns) * 1e-9;
  double time_sum = 0;
  for (const PhotodiodeSample& sample : samples) {
    record.times_s.push_back(static_cast<double>(sample.monotonic_ns - first_ns) * 1e-9);
    record.values.push_back(sample.counts);
    record.mean += sample.counts;
    time_sum += record.times_s.back();
  }
  const auto count = static_cast<double>(samples.size());
  record.mean /= count;
  double tt = 0;
  double tv = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    record.times_s[i] -= time_sum / count;
    record.values[i] -= record.mean;
    tt += record.times_s[i] * record.times_s[i];
    tv += record.times_s[i] * record.values[i];
  }
  for (size_t i = 0; i < samples.size(); ++i) record.values[i] -= tv / tt * record.times_s[i];
  return record;
}

double MedianIntervalS(const StrobeRecord& record) {
  std::vector<double> intervals;
  for (size_t i = 1; i < record.times_s.size(); ++i) {
    intervals.push_back(record.times_s[i] - record.times_s[i - 1]);
  }
  const auto middle = intervals.begin() + intervals.size() / 2;
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

double SumOfSquares(const StrobeRecord& record) {
  double sum = 0;
  for (const double value : record.values) sum += value * value;
  return sum;
}

StrobeRecord Without(const StrobeRecord& record, const Sinusoid& fit) {
  StrobeRecord rest = record;
  for (size_t i = 0; i < rest.values.size(); ++i) {
    const double angle = 2 * std::numbers::pi * fit.frequency_hz * rest.times_s[i];
    rest.values[i] -= fit.cosine * std::cos(angle) + fit.sine * std::sin(angle);
  }
  return rest;
}

// Where flashes alternate, the strongest frequency is a harmonic of the true one. A subharmonic
// counts when it is significant and not merely the leakage of what is stronger.
double Fundamental(const StrobeRecord& record, const Sinusoid& strongest, double low_hz) {
  constexpr double kLeastShare = 0.02;  // of the strongest amplitude
  const StrobeRecord rest = Without(record, strongest);
  const double sum = SumOfSquares(rest);
  for (const double divisor : {3.0, 2.0}) {
    const double hz = strongest.frequency_hz / divisor;
    if (hz < low_hz) continue;
    const Sinusoid fit = FitAmplitudes(rest, hz);
    const double share =
        std::hypot(fit.cosine, fit.sine) / std::hypot(strongest.cosine, strongest.sine);
    if (share > kLeastShare && IsSignificant(rest, sum, fit.sum_of_squares, 2)) return hz;
  }
  return strongest.frequency_hz;
}

// Least squares of a sinusoid: sigma_f = sqrt(6 / N) rms / (pi A T), with everything that the
// sinusoid does not explain, harmonics included, taken for noise.
double FrequencySigmaHz(const StrobeRecord& record, const Sinusoid& fit) {
  const auto count = static_cast<double>(record.values.size());
  const double rms = std::sqrt(std::max(fit.sum_of_squares, 0.0) / (count - 3));
  const double amplitude = std::hypot(fit.cosine, fit.sine);
  return std::sqrt(6 / count) * rms / (std::numbers::pi * amplitude * record.span_s);
}

// Noise of the mean and of the two plateaus, and where the edges can lie between the phases that
// were sampled.
double DutySigma(const StrobeRecord& record, const FoldedPeriod& folded) {
  const auto count = static_cast<double>(record.values.size());
  const double lit = std::max(folded.duty * count, 1.0);
  const double unlit = std::max((1 - folded.duty) * count, 1.0);
  const double relative_noise = folded.residual_rms / (folded.high - folded.low);
  // The median of a plateau is 1.25 times as noisy as its mean.
  const double levels =
      1.25 * std::hypot(folded.duty / std::sqrt(lit), (1 - folded.duty) / std::sqrt(unlit));
  const double noise = relative_noise * std::hypot(1 / std::sqrt(count), levels);
  return std::hypot(noise, folded.largest_gap / std::sqrt(6.0));
}

absl::Status CheckSampling(const StrobeMeasurement& measured, double rate_hz,
                           const StrobeOptions& options) {
  const double frequency_hz = 1 / measured.period_s;
  if (measured.samples_per_period < options.minimum_samples_per_period) {
    return Rejected(
        kWhere,
        "the light changes at " + std::to_string(frequency_hz) + " Hz and was sampled " + "at " +
            std::to_string(rate_hz) + " Hz, too slowly to exclude an alias",
        "sample at " + std::to_string(options.minimum_samples_per_period * frequency_hz) +
            " Hz or faster");
  }
  if (measured.periods < options.minimum_periods) {
    return Rejected(kWhere, "spans " + std::to_string(measured.periods) + " periods",
                    "sample for " + std::to_string(options.minimum_periods * measured.period_s) +
                        " s or longer");
  }
  return absl::OkStatus();
}

void SetLevels(const FoldedPeriod& folded, double mean, StrobeMeasurement& measured) {
  measured.low_counts = mean + folded.low;
  measured.high_counts = mean + folded.high;
  measured.depth = (folded.high - folded.low) / std::max(std::abs(measured.high_counts), 1e-9);
}

}  // namespace

absl::Status StrobeOptions::Validate() const {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0; };
  if (!positive(frequency_min_hz) || !(frequency_max_hz > frequency_min_hz)) {
    return BadInput("StrobeOptions.frequency_min_hz", "and frequency_max_hz are no range",
                    "give two frequencies above 0, the lower one first");
  }
  if (!positive(minimum_depth)) {
    return BadInput("StrobeOptions.minimum_depth", "is not above 0", "give a share like 0.01");
  }
  if (!positive(minimum_periods)) {
    return BadInput("StrobeOptions.minimum_periods", "is not above 0", "give 20, say");
  }
  if (!(minimum_samples_per_period > 2)) {
    return BadInput("StrobeOptions.minimum_samples_per_period", "is not above 2", "give 4, say");
  }
  return absl::OkStatus();
}

absl::StatusOr<StrobeMeasurement> MeasureStrobe(std::span<const PhotodiodeSample> samples,
                                                const StrobeOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckSamples(samples, options));
  const StrobeRecord record = RecordOf(samples);
  const double rate_hz = 1 / MedianIntervalS(record);
  const double high_hz = std::min(options.frequency_max_hz, rate_hz / 2);
  const double low_hz = std::max(options.frequency_min_hz, 2 / record.span_s);
  StrobeMeasurement measured;
  measured.low_counts = measured.high_counts = record.mean;
  const double sum = SumOfSquares(record);
  measured.noise_counts = std::sqrt(sum / static_cast<double>(samples.size()));
  if (high_hz <= low_hz) {
    return Rejected(kWhere, "is too short or too slow to show any flashing",
                    "sample for longer than " + std::to_string(2 / options.frequency_min_hz) +
                        " s and faster than " + std::to_string(2 * options.frequency_min_hz) +
                        " Hz");
  }
  const Sinusoid strongest = FindSinusoid(record, low_hz, high_hz);
  const double trials = 4 * record.span_s * (high_hz - low_hz);
  if (!IsSignificant(record, sum, strongest.sum_of_squares, trials)) return measured;
  const double frequency_hz = Fundamental(record, strongest, low_hz);
  const FoldedPeriod folded = Fold(record, 1 / frequency_hz);
  SetLevels(folded, record.mean, measured);
  if (measured.depth < options.minimum_depth) return measured;
  measured.strobed = true;
  measured.period_s = 1 / frequency_hz;
  measured.period_sigma_s =
      measured.period_s * FrequencySigmaHz(record, strongest) / strongest.frequency_hz;
  measured.samples_per_period = rate_hz * measured.period_s;
  measured.periods = record.span_s / measured.period_s;
  EYEBOX_RETURN_IF_ERROR(CheckSampling(measured, rate_hz, options));
  measured.noise_counts = folded.residual_rms;
  measured.duty = folded.duty;
  measured.duty_sigma = DutySigma(record, folded);
  return measured;
}

absl::Status CheckNotAliased(const StrobeMeasurement& first, const StrobeMeasurement& second) {
  if (!first.strobed && !second.strobed) return absl::OkStatus();
  if (first.strobed != second.strobed) {
    return Rejected(kWhere, "is steady at one sample rate and flashes at the other",
                    "sample faster: what flashes is an alias");
  }
  const double first_rate_hz = first.samples_per_period / first.period_s;
  const double second_rate_hz = second.samples_per_period / second.period_s;
  if (std::abs(first_rate_hz / second_rate_hz - 1) < 0.02) {
    return BadInput(kWhere, "was taken twice at nearly the same sample rate",
                    "change the rate by 5 % or more and measure again");
  }
  const double sigma_s = std::hypot(first.period_sigma_s, second.period_sigma_s);
  if (std::abs(first.period_s - second.period_s) <= 4 * sigma_s) return absl::OkStatus();
  return Rejected(kWhere,
                  "gives " + std::to_string(1 / first.period_s) + " Hz at one sample rate and " +
                      std::to_string(1 / second.period_s) + " Hz at the other: an alias",
                  "sample faster than twice the flashing");
}

}  // namespace eyebox::capture
