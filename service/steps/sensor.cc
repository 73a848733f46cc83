#include "service/steps/sensor.h"

#include <string>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/results/characterize.h"

namespace eyebox::service {
namespace {

constexpr const char* kFiles[] = {"defects.npy", "sensor.json"};
constexpr size_t kLargestFile = size_t{1} << 30;

absl::Status CheckSame(const std::filesystem::path& folder, const char* what,
                       const std::string& sensor, const std::string& camera) {
  if (sensor.empty() || camera.empty() || sensor == camera) return absl::OkStatus();
  return BadInput(
      folder.string(),
      absl::StrCat("it was characterised with ", what, " ", sensor, ", the frames are of ", camera),
      "characterise this camera as it is set");
}

std::string SizeText(ImageSize size) {
  return absl::StrCat(size.width_px, " x ", size.height_px, " px");
}

}  // namespace

std::filesystem::path SensorFolder(const std::filesystem::path& recording,
                                   const std::filesystem::path& asked) {
  if (!asked.empty()) return asked;
  std::error_code absent;
  const std::filesystem::path kept = recording / kSensorFolder;
  return std::filesystem::exists(kept, absent) ? kept : std::filesystem::path();
}

absl::StatusOr<optics::SensorCharacterisation> ReadSensorOf(const capture::CameraInfo& camera,
                                                            const std::filesystem::path& folder) {
  EYEBOX_ASSIGN_OR_RETURN(optics::SensorCharacterisation sensor, ReadSensor(folder));
  const optics::SensorIdentity& known = sensor.identity;
  EYEBOX_RETURN_IF_ERROR(CheckSame(folder, "camera", known.model, camera.model));
  EYEBOX_RETURN_IF_ERROR(CheckSame(folder, "serial number", known.serial, camera.serial));
  EYEBOX_RETURN_IF_ERROR(
      CheckSame(folder, "pixel format", known.pixel_format, camera.pixel_format));
  EYEBOX_RETURN_IF_ERROR(CheckSame(folder, "significant bits:", absl::StrCat(known.bits),
                                   absl::StrCat(camera.significant_bits)));
  EYEBOX_RETURN_IF_ERROR(CheckSame(folder, "frames of", SizeText(sensor.defects.defective.size()),
                                   SizeText(camera.sensor_size)));
  return sensor;
}

absl::Status KeepSensor(const std::filesystem::path& folder,
                        const std::filesystem::path& recording) {
  for (const char* name : kFiles) {
    EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(folder / name, kLargestFile));
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(recording / kSensorFolder / name, bytes));
  }
  return absl::OkStatus();
}

}  // namespace eyebox::service
