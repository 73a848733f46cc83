// recording.textproto as text.
#ifndef EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "capture/recording/header.h"

namespace eyebox::capture {

// Errors: InvalidArgument (a header that could not be read back: names the field).
absl::StatusOr<std::string> HeaderText(const RecordingHeader& header);

// Errors: InvalidArgument naming `file`, line and field.
absl::StatusOr<RecordingHeader> ParseHeader(const std::string& text,
                                            const std::filesystem::path& file);

// One message each, as text: what a capture file says of itself under /meta.
std::string CaptureText(const CaptureSpec& spec);
std::string CameraText(const CameraInfo& camera);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_
