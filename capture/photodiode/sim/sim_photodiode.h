// A simulated photodiode before a simulated strobed display.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SIM_SIM_PHOTODIODE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SIM_SIM_PHOTODIODE_H_

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/photodiode/photodiode.h"
#include "capture/photodiode/sim/strobe_light.h"

namespace eyebox::capture {

// counts = dark + level (1 + drift t) light(t) + noise, rounded and clipped to the rails.
struct SimPhotodiodeParameters {
  StrobeLight light = {};
  double level_counts = 600;  // while lit, above the dark
  double dark_counts = 20;
  double noise_counts = 3;   // rms
  double drift_per_s = 0;    // relative change of the level
  double time_jitter_s = 0;  // rms error of the times that are reported
  double settling_s = 0;     // time constant of the analogue low-pass; 0: none
  double lost_share = 0;     // probability that a conversion is lost
  int bits = 10;
  double sample_rate_max_hz = 20000;
  int samples_per_block = 64;

  // Errors: InvalidArgument (names the field and its range).
  absl::Status Validate() const;
};

// "strobe-90hz" (duty 0.2), "strobe-72hz" (duty 0.1), "steady" (does not flash).
// Errors: InvalidArgument (unknown name: lists the known ones).
absl::StatusOr<SimPhotodiodeParameters> NamedSimPhotodiode(std::string_view name);
std::vector<std::string> SimPhotodiodeNames();

// Conversion k begins k sample periods after Start() and can be read once the clock is past it; its
// counts are a function of seed, k and the time since Start() alone. Never pulse-started.
// Read() waits in real time, so that with a ManualClock it gives what is there or times out.
// Errors: InvalidArgument.
absl::StatusOr<std::unique_ptr<Photodiode>> MakeSimPhotodiode(
    const PhotodiodeConfig& config, const SimPhotodiodeParameters& parameters, const Clock* clock);

// config.uri is "sim:NAME".
absl::StatusOr<std::unique_ptr<Photodiode>> OpenSimPhotodiode(const PhotodiodeConfig& config,
                                                              const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SIM_SIM_PHOTODIODE_H_
