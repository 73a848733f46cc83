// A file that nobody but its owner may read.
#ifndef EYEBOX_SERVICE_SERVER_SECRET_FILE_H_
#define EYEBOX_SERVICE_SERVER_SECRET_FILE_H_

#include <cstddef>
#include <filesystem>
#include <string>

#include "absl/status/statusor.h"

namespace eyebox::service {

// Checked on the open file, so that it cannot be exchanged in between. Errors: NotFound,
// FailedPrecondition (others may read or write it), InvalidArgument (no file, or too large).
absl::StatusOr<std::string> ReadSecretFile(const std::filesystem::path& file, size_t limit_bytes);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_SECRET_FILE_H_
