// A camera's sensor from EMVA 1288 descriptor files or from a recording.
#ifndef EYEBOX_SERVICE_STEPS_CHARACTERIZE_H_
#define EYEBOX_SERVICE_STEPS_CHARACTERIZE_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/sensor/sensor_characterisation.h"
#include "service/watcher.h"

namespace eyebox::service {

struct CharacterizedSensor {
  optics::SensorCharacterisation sensor;
  std::string source;
  std::string irradiation_unit;  // "photon" or "DN"
  int bits = 0;
  optics::PixelRegion region;
};

// Every image is read once. Errors: those of ReadEmva1288Descriptor, ReadSeries and
// CharacteriseSensor.
absl::StatusOr<CharacterizedSensor> CharacterizeDescriptor(const std::filesystem::path& descriptor,
                                                           const Watcher& watcher);

// Darks, flats and, where the flats have fewer than ten exposures, the full fields that the headset
// showed as well. Captures of one setting and stimulus count as
// one set. Measured is the middle third of the field, where light is most even; the defect map is
// that of the whole. Light of each stimulus is known up to a factor, which one of its own exposures
// below half of full scale fixes: K, noise and saturation come from all, linearity from the
// exposures of one. Memory: one set, three mean images.
// Errors: those of reading and CharacteriseSensor; FailedPrecondition (no darks, or no light of
// their gain).
absl::StatusOr<CharacterizedSensor> CharacterizeCaptures(capture::RecordingReader& recording,
                                                         const Watcher& watcher);

// The same of the recording in that folder; messages name it.
absl::StatusOr<CharacterizedSensor> CharacterizeRecording(const std::filesystem::path& recording,
                                                          const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_CHARACTERIZE_H_
