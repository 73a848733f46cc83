// A sensor's characterisation as a result message, and back.
#ifndef EYEBOX_SERVICE_RESULTS_CHARACTERIZE_H_
#define EYEBOX_SERVICE_RESULTS_CHARACTERIZE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "eyebox/v1/characterize.pb.h"
#include "optics/sensor/sensor_characterisation.h"
#include "service/steps/characterize.h"

namespace eyebox::service {

// Writes defects.npy and sensor.json, this very message, into `folder` unless it is empty.
absl::StatusOr<v1::CharacterizeResult> DescribeSensor(const CharacterizedSensor& sensor,
                                                      const std::filesystem::path& folder);

// What ApplySensor needs, from sensor.json and defects.npy in `folder`: noise model, linearity and
// defects; of the EMVA figures K, dark noise and dark mean.
// Errors: NotFound, InvalidArgument (a parameter is missing, the knots do not rise), DataLoss
// (defects.npy is not the file that was written).
absl::StatusOr<optics::SensorCharacterisation> ReadSensor(const std::filesystem::path& folder);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_CHARACTERIZE_H_
