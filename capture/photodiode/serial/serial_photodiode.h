// A photodiode on the ADC of an Arduino UNO; the sketch and the protocol are in ../arduino/.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_SERIAL_PHOTODIODE_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_SERIAL_PHOTODIODE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

// config.uri is "serial:DEVICE". Opening may reset the board; it is given 5 s to answer.
// A sample's time is exact to time_uncertainty_ns of its block (see serial/clock_map.h), times
// within a block and from block to block ascend. A board that restarts while running is lost.
// Errors: those of serial::Port::Open(); Unavailable (no answer, another protocol: says which).
absl::StatusOr<std::unique_ptr<Photodiode>> OpenSerialPhotodiode(const PhotodiodeConfig& config,
                                                                 const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_SERIAL_PHOTODIODE_H_
