// The characterised sensor that a rig or a command names, and the copy that a recording keeps.
#ifndef EYEBOX_SERVICE_STEPS_SENSOR_H_
#define EYEBOX_SERVICE_STEPS_SENSOR_H_

#include <filesystem>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/camera.h"
#include "optics/sensor/sensor_characterisation.h"

namespace eyebox::service {

inline constexpr char kSensorFolder[] = "sensor";  // of a recording

// `asked` where a command names one, else the copy in `recording`, else empty: none.
std::filesystem::path SensorFolder(const std::filesystem::path& recording,
                                   const std::filesystem::path& asked);

// Reads `folder` and compares it with the camera. What either does not know is not compared.
// Errors: those of ReadSensor; InvalidArgument (another model, serial number, pixel format, size
// or number of bits: names both).
absl::StatusOr<optics::SensorCharacterisation> ReadSensorOf(const capture::CameraInfo& camera,
                                                            const std::filesystem::path& folder);

// Copies it into `recording`. Errors: NotFound, the errno of the disk.
absl::Status KeepSensor(const std::filesystem::path& folder,
                        const std::filesystem::path& recording);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_SENSOR_H_
