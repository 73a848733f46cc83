// The camera, from the darks, flats and repeats of the recording itself.
#ifndef EYEBOX_SERVICE_STEPS_CALIBRATE_H_
#define EYEBOX_SERVICE_STEPS_CALIBRATE_H_

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/reduce/calibration.h"
#include "service/watcher.h"

namespace eyebox::service {

// Darks, hot pixels, noise, flat and luminance scale. Without flats the calibration has none.
// Errors: those of reading; FailedPrecondition (no darks, nothing to learn the noise from, flats
// of several luminances).
absl::StatusOr<optics::Calibration> CalibrateCamera(capture::RecordingReader& recording,
                                                    const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_CALIBRATE_H_
