// How a display flashes, from a photodiode that looks at it: what an exposure must be a multiple
// of.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_STROBE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_STROBE_H_

#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

struct StrobeOptions {
  double frequency_min_hz = 20;
  double frequency_max_hz = 5000;  // of flashing; lowered to what the sample rate can show
  double minimum_depth = 0.01;     // flashing weaker than this, (high - low) / high, is none
  double minimum_periods = 20;     // in the samples
  // Fewer samples per period than this are refused: a faster flashing would look the same.
  double minimum_samples_per_period = 4;
  // The rails of the converter, as in PhotodiodeInfo.
  int32_t minimum_counts = 0;
  int32_t maximum_counts = INT32_MAX;

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

// Uncertainties are standard uncertainties (k = 1).
struct StrobeMeasurement {
  bool strobed = false;  // false: steady within minimum_depth; period and duty are then 0 and 1
  double period_s = 0;
  double period_sigma_s = 0;
  double duty = 1;  // lit share of a period: mean above low, over high above low
  double duty_sigma = 0;
  double low_counts = 0;
  double high_counts = 0;
  double depth = 0;         // (high - low) / high; above 1 where low is negative
  double noise_counts = 0;  // rms of the samples about what was fitted
  double samples_per_period = 0;
  double periods = 0;  // that the samples span
};

// Samples of a steady scene, times ascending; gaps are allowed. A linear drift is removed.
// The frequency is that of the sinusoid that explains most, refined by least squares; a strobe
// whose every second or third flash differs counts as one long period. Level and duty come from the
// samples folded at the period.
// Errors: InvalidArgument (fewer than 16 samples, times not ascending); FailedPrecondition (clipped
// samples, too few periods, too few samples per period: says which rate is needed).
//
// One record cannot tell a flashing faster than half the sample rate from its alias: take two, at
// rates that have no small common multiple, and compare them with CheckNotAliased().
absl::StatusOr<StrobeMeasurement> MeasureStrobe(std::span<const PhotodiodeSample> samples,
                                                const StrobeOptions& options);

// An alias moves when the sample rate does; a true period stays.
// Errors: InvalidArgument (the two sample rates are within 2 % of each other), FailedPrecondition
// (the periods differ by more than 4 sigma, or one of the two is steady).
absl::Status CheckNotAliased(const StrobeMeasurement& first, const StrobeMeasurement& second);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_STROBE_H_
