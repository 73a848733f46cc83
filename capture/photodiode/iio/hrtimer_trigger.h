// A timer of the kernel that starts conversions (Linux configfs, iio-trig-hrtimer).
#ifndef EYEBOX_CAPTURE_PHOTODIODE_IIO_HRTIMER_TRIGGER_H_
#define EYEBOX_CAPTURE_PHOTODIODE_IIO_HRTIMER_TRIGGER_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"

namespace eyebox::capture::iio {

// Makes the hrtimer trigger `name` unless it exists. It stays until the next boot: another program
// may have attached it meanwhile. Errors: Unavailable (no configfs, no module, no permission; says
// what to do).
absl::Status EnsureHrtimerTrigger(
    const std::string& name,
    const std::filesystem::path& folder = "/sys/kernel/config/iio/triggers/hrtimer");

}  // namespace eyebox::capture::iio

#endif  // EYEBOX_CAPTURE_PHOTODIODE_IIO_HRTIMER_TRIGGER_H_
