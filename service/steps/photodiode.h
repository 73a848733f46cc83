// What a photodiode read while a capture was taken.
#ifndef EYEBOX_SERVICE_STEPS_PHOTODIODE_H_
#define EYEBOX_SERVICE_STEPS_PHOTODIODE_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"

namespace eyebox::service {

struct PhotodiodeMean {
  double counts = 0;
  int64_t readings = 0;  // conversions, or frames that state one
  bool clipped = false;  // many of the conversions lie on the upper rail of the converter
};

// The mean of the conversions during the capture under a Hann window: a display that flashes leaves
// of its ripple only (flashes in the capture)^-3, whatever the period. Of imported frames the mean
// of the counts that they state. None where there is neither. Errors: those of reading.
absl::StatusOr<std::optional<PhotodiodeMean>> ReadPhotodiode(capture::RecordingReader& recording,
                                                             const capture::CaptureEntry& entry);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_PHOTODIODE_H_
