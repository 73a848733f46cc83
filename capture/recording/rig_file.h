// A rig file: the message eyebox.v1.Rig as textproto.
#ifndef EYEBOX_CAPTURE_RECORDING_RIG_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_RIG_FILE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

// Errors: those of ReadWholeFile; InvalidArgument (file, line and field named: unknown field, name
// that is not [a-z0-9-]{1,63}, URI of a scheme that no camera here has).
absl::StatusOr<RigConfig> ReadRigFile(const std::filesystem::path& file);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_RIG_FILE_H_
