#include "capture/photodiode/iio/hrtimer_trigger.h"

#include <system_error>

#include "capture/base/status.h"

namespace eyebox::capture::iio {

absl::Status EnsureHrtimerTrigger(const std::string& name, const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    return DeviceFailed(folder.string(), "is not there, so that no timer can start conversions",
                        "mount configfs and load the module iio-trig-hrtimer, or name a trigger: "
                        "iio:DEVICE/CHANNEL?trigger=NAME");
  }
  std::filesystem::create_directory(folder / name, error);
  if (!error) return absl::OkStatus();
  return DeviceFailed((folder / name).string(), error.message(),
                      "make it as root, or name another trigger");
}

}  // namespace eyebox::capture::iio
