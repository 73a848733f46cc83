// What every photodiode can do: raw counts of an ADC, each with its time. The mapping from counts
// to cd/m2 is learnt elsewhere (optics/photometry).
#ifndef EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/base/sample_block.h"

namespace eyebox::capture {

struct PhotodiodeInfo {
  std::string uri;  // as opened, for example "serial:/dev/ttyACM0"
  std::string model;
  int significant_bits = 0;    // of the counts
  int32_t minimum_counts = 0;  // the rails of the converter: a count on one of them is clipped
  int32_t maximum_counts = 0;
  double sample_rate_min_hz = 0;
  double sample_rate_max_hz = 0;
  bool can_be_pulse_started = false;  // one conversion per pulse on its trigger input
};

struct PhotodiodeSettings {
  double sample_rate_hz = 1000;  // of the converter's own timer; not looked at if pulse_started
  bool pulse_started = false;
  friend bool operator==(const PhotodiodeSettings&, const PhotodiodeSettings&) = default;
};

// Not thread-safe: one thread at a time.
class Photodiode {
 public:
  virtual ~Photodiode() = default;

  virtual const PhotodiodeInfo& Info() const = 0;

  // Sets the converter and returns what it reads back; the rate is the nearest it can do.
  // Errors: InvalidArgument (outside the limits of Info()), FailedPrecondition (running),
  // Unavailable.
  virtual absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) = 0;

  // Conversions run from here on. Errors: FailedPrecondition (running or never configured),
  // Unavailable.
  virtual absl::Status Start() = 0;

  // The next block. Errors: DeadlineExceeded (nothing came), FailedPrecondition (not started),
  // Unavailable (unplugged, or a timed converter that fell silent), OutOfRange (a replay's end).
  virtual absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds timeout) = 0;

  // Drops what is pending. Stopping a stopped photodiode is not an error.
  virtual absl::Status Stop() = 0;
};

struct PhotodiodeConfig {
  // "iio:DEVICE/CHANNEL[?trigger=NAME]", "serial:/dev/ttyACM0", "sim:NAME", "replay:DIR".
  std::string uri;
  uint64_t seed = 1;  // of everything random in a simulated one
};

// Opens what the URI names. `clock` must outlive the photodiode and, for serial:, be thread-safe.
// Errors: InvalidArgument (unknown scheme: lists the known ones), NotFound, Unavailable,
// ResourceExhausted (serial: another program holds the port).
absl::StatusOr<std::unique_ptr<Photodiode>> OpenPhotodiode(const PhotodiodeConfig& config,
                                                           const Clock* clock);

// "iio", "serial", ... in the order in which `eyebox devices` lists them.
std::vector<std::string> PhotodiodeSchemes();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_PHOTODIODE_H_
