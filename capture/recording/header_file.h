// recording.textproto as text.
#ifndef EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "capture/recording/capture_file.h"
#include "capture/recording/header.h"
#include "capture/recording/manifest.h"

namespace eyebox::capture {

// Errors: InvalidArgument (a header that could not be read back: names the field).
absl::StatusOr<std::string> HeaderText(const RecordingHeader& header);

// Errors: InvalidArgument naming `file`, line and field.
absl::StatusOr<RecordingHeader> ParseHeader(const std::string& text,
                                            const std::filesystem::path& file);

// Reads recording.textproto. Errors: those of ParseHeader; NotFound; DataLoss (it is not what
// `manifest` says was written).
absl::StatusOr<RecordingHeader> ReadHeader(const std::filesystem::path& recording,
                                           const Manifest& manifest);

// What a capture file says of itself under /meta, so that it is understood alone.
MetaStrings CaptureMeta(const CameraInfo& camera, const CaptureSpec& spec);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_HEADER_FILE_H_
