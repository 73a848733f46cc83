// The camera, from the darks, flats and repeats of the recording itself.
#ifndef EYEBOX_SERVICE_STEPS_CALIBRATE_H_
#define EYEBOX_SERVICE_STEPS_CALIBRATE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/reduce/calibration.h"
#include "service/watcher.h"

namespace eyebox::service {

// Darks, hot pixels, noise, flat and luminance scale. Without flats the calibration has none.
// Darks that are more than 1 K apart stay apart, see DarkFor().
// A light without a dark of its setting gets one interpolated where the darks prove it, see
// InterpolateDark(); else reducing it fails and says why.
// `sensor_folder`, unless empty, holds the characterised sensor (see sensor.h): gain, read noise,
// saturation, linearity and defects come from it, and no repeats are needed.
// Errors: those of reading; FailedPrecondition (no darks, nothing to learn the noise from, flats
// of several luminances); those of ReadSensorOf and ApplySensor.
absl::StatusOr<optics::Calibration> CalibrateCamera(
    capture::RecordingReader& recording, const Watcher& watcher,
    const std::filesystem::path& sensor_folder = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_CALIBRATE_H_
