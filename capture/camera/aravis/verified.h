// Features that are written, read back and compared.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_VERIFIED_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_VERIFIED_H_

#include <string>

#include "absl/status/status.h"
#include "capture/camera/aravis/device.h"

namespace eyebox::capture::aravis {

// A feature that holds the value already is not written: it may be locked.
// Errors: Unavailable (names the feature, what was written and what it reads back).
absl::Status HoldText(Device& device, const std::string& feature, const std::string& value);
absl::Status HoldSwitch(Device& device, const std::string& feature, bool value);
absl::Status HoldInteger(Device& device, const std::string& feature, int64_t value);
absl::Status HoldFloat(Device& device, const std::string& feature, double value);

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_VERIFIED_H_
