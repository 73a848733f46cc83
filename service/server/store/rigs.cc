#include "service/server/store/rigs.h"

#include "absl/strings/str_replace.h"
#include "capture/base/status.h"
#include "capture/recording/rig_file.h"

namespace eyebox::service {

absl::StatusOr<capture::RigConfig> ReadRig(const RootFolder& data, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string path, CheckName(kRigNameRule, "rig", name));
  const auto file = data.OpenFile(path + std::string(kRigSuffix));
  if (!file.ok()) return WithField(file.status(), "rig");
  auto config = capture::ReadRigFile(file->Path());
  if (!config.ok()) {
    return absl::Status(
        config.status().code(),
        absl::StrReplaceAll(config.status().message(), {{file->Path().string(), name}}));
  }
  if (!config->sensor.empty()) {
    return Rejected(name, "names the folder of a sensor, which the server does not follow",
                    "leave it out here, and give the sensor when the recording is analysed");
  }
  return config;
}

absl::StatusOr<capture::RigConfig> RigOfWork(const RootFolder& data, const v1::CaptureWork& work) {
  if (work.has_simulated()) return ConfigOf(work.simulated());
  return ReadRig(data, work.rig());
}

capture::RigConfig ConfigOf(const v1::Rig& rig) {
  return {.name = rig.name(),
          .camera_uri = rig.camera_uri(),
          .seed = rig.seed(),
          .photodiode_uri = rig.photodiode_uri(),
          .trigger_uri = rig.trigger_uri(),
          .camera_trigger_line = rig.camera_trigger_line()};
}

}  // namespace eyebox::service
