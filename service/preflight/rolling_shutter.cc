#include "service/preflight/rolling_shutter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "absl/strings/str_format.h"
#include "service/preflight/fisher_test.h"

namespace eyebox::service {
namespace {

constexpr size_t kLeastRows = 8;

// Mean over the frames of each row; empty unless every frame has the same rows.
std::vector<double> MeanRows(std::span<const std::vector<double>> frames) {
  std::vector<double> mean(frames[0].size(), 0.0);
  for (const std::vector<double>& frame : frames) {
    if (frame.size() != mean.size()) return {};
    for (size_t y = 0; y < mean.size(); ++y) mean[y] += frame[y];
  }
  for (double& value : mean) value /= static_cast<double>(frames.size());
  return mean;
}

// |DFT|^2 of the residuals at 1, 2, ... cycles per frame, Nyquist left out.
std::vector<double> Periodogram(std::span<const double> residuals) {
  const size_t n = residuals.size();
  std::vector<double> powers;
  for (size_t k = 1; 2 * k < n; ++k) {
    std::complex<double> sum = 0;
    for (size_t y = 0; y < n; ++y) {
      const double turns = static_cast<double>(k * y % n) / static_cast<double>(n);
      sum += residuals[y] * std::polar(1.0, -2 * std::numbers::pi * turns);
    }
    powers.push_back(std::norm(sum));
  }
  return powers;
}

struct Band {
  double false_alarm_probability = 1;
  double period_rows = 0;
  double amplitude = 0;
};

Band LargestBand(std::span<const std::vector<double>> frames, std::span<const double> mean) {
  Band largest;
  const auto rows = static_cast<double>(mean.size());
  for (const std::vector<double>& frame : frames) {
    std::vector<double> residuals(mean.size());
    for (size_t y = 0; y < mean.size(); ++y) residuals[y] = frame[y] / mean[y] - 1;
    const std::vector<double> powers = Periodogram(residuals);
    const SpectralPeak peak = LargestPeak(powers);
    if (peak.false_alarm_probability >= largest.false_alarm_probability) continue;
    largest = {.false_alarm_probability = peak.false_alarm_probability,
               .period_rows = rows / static_cast<double>(peak.index + 1),
               .amplitude = 2 * std::sqrt(powers[peak.index]) / rows};
  }
  // The largest of so many frames.
  largest.false_alarm_probability =
      std::min(1.0, largest.false_alarm_probability * static_cast<double>(frames.size()));
  return largest;
}

}  // namespace

Check CheckRollingShutter(std::span<const std::vector<double>> row_means_dn,
                          const BandOptions& options) {
  Check check = {.name = "rolling_shutter",
                 .wanted = absl::StrFormat("no row-periodic peak (false alarm above %g)",
                                           options.false_alarm_probability),
                 .threshold = options.false_alarm_probability};
  const auto mean = row_means_dn.size() < 2 ? std::vector<double>() : MeanRows(row_means_dn);
  if (mean.size() < kLeastRows || !std::ranges::all_of(mean, [](double dn) { return dn > 0; })) {
    return std::move(check).Skipped("there are no two frames with light in every row",
                                    "show a steady full field that is brighter than its dark");
  }
  const Band band = LargestBand(row_means_dn, mean);
  check.measured = Figure{"false_alarm_probability", band.false_alarm_probability, 0, "1"};
  check.figures = {{"band_period", band.period_rows, 0, "px"},
                   {"band_amplitude", band.amplitude, 0, "1"}};
  if (band.false_alarm_probability > options.false_alarm_probability) return check;
  return std::move(check).Failed(
      absl::StrFormat("bands every %.1f rows, %.3g %% high: a rolling shutter sees the display "
                      "flash",
                      band.period_rows, 100 * band.amplitude),
      "switch the camera to global shutter or global reset; if it has none, expose only for whole "
      "numbers of refresh periods, where the bands vanish, and do not trust other exposures");
}

}  // namespace eyebox::service
