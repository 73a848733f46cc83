// The luminance scale that a command names.
#ifndef EYEBOX_SERVICE_STEPS_KNOWN_SCALE_H_
#define EYEBOX_SERVICE_STEPS_KNOWN_SCALE_H_

#include <filesystem>

#include "absl/status/status.h"
#include "optics/reduce/calibration.h"

namespace eyebox::service {

// Reads what `eyebox photometry scale` wrote and makes it the luminance of 1 DN/s. Does nothing for
// an empty name.
// Errors: NotFound, InvalidArgument (it holds no luminance scale), FailedPrecondition (it was not
// accepted, or the recording's flat has a known luminance, which is a scale already).
absl::Status UseScale(const std::filesystem::path& file, optics::Calibration& calibration);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_KNOWN_SCALE_H_
