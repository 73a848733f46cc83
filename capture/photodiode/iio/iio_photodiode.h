// A photodiode on a converter of the Linux Industrial I/O subsystem, read through its buffer.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_PHOTODIODE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_PHOTODIODE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "capture/photodiode/iio/iio_device.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

// Sets the time stamps to CLOCK_MONOTONIC and reads that back. A kernel buffer that overflows drops
// silently and counts nothing: with a timed trigger lost conversions are found as gaps between time
// stamps; with a trigger that pulses start they show only when pulses and samples are compared
// (capture/trigger/match_edges.h).
// Errors: Unavailable (the clock cannot be set), those of the device.
absl::StatusOr<std::unique_ptr<Photodiode>> MakeIioPhotodiode(
    std::string uri, std::unique_ptr<iio::IioDevice> device, const Clock* clock);

// config.uri is "iio:DEVICE/CHANNEL[?trigger=NAME]".
absl::StatusOr<std::unique_ptr<Photodiode>> OpenIioPhotodiode(const PhotodiodeConfig& config,
                                                              const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_IIO_IIO_PHOTODIODE_H_
