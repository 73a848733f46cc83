// Whole small files: read with a limit, written all or not at all.
#ifndef EYEBOX_CAPTURE_BASE_FILE_H_
#define EYEBOX_CAPTURE_BASE_FILE_H_

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox {

// Errors: NotFound, PermissionDenied, or InvalidArgument if it holds more than `limit_bytes`.
absl::StatusOr<std::string> ReadWholeFile(const std::filesystem::path& file,
                                          size_t limit_bytes = size_t{64} << 20);

// Writes beside the target, fsyncs, renames, fsyncs the folder: a reader sees the old file or the
// new one, never a part. Creates missing parent folders. Errors: the errno of the file system.
absl::Status WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_FILE_H_
