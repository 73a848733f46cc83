// Errors as values: absl::Status from ioctl to client, no exception crosses a folder.
//
// A message says what was wrong, where (file, line, field or frame) and what to do about it.
// The canonical code decides the exit status of the command line (see ExitCodeFor).
#ifndef EYEBOX_CAPTURE_BASE_STATUS_H_
#define EYEBOX_CAPTURE_BASE_STATUS_H_

#include <string>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox {

// "WHERE: WHAT; REMEDY". `where` names a file (with line or field), a frame or an argument.
std::string Complaint(std::string_view where, std::string_view what, std::string_view remedy);

// The input is malformed or does not make sense. Exit code 3.
absl::Status BadInput(std::string_view where, std::string_view what, std::string_view remedy);
// The input should exist and does not. Exit code 3.
absl::Status Missing(std::string_view where, std::string_view what, std::string_view remedy);
// Stored bytes are not what was written (checksum, length). Exit code 3.
absl::Status Corrupt(std::string_view where, std::string_view what, std::string_view remedy);
// A camera, photodiode or trigger did not answer as it must. Exit code 4.
absl::Status DeviceFailed(std::string_view where, std::string_view what, std::string_view remedy);
// The data are sound but the measurement does not meet what it must meet. Exit code 5.
absl::Status Rejected(std::string_view where, std::string_view what, std::string_view remedy);
// The disk or the operating system refused; `error_number` is an errno value. Exit code 3.
absl::Status SystemFailed(std::string_view where, int error_number, std::string_view remedy);

// 0 done, 3 bad input, 4 device, 5 measurement rejected. (2, usage, is the parser's.)
int ExitCodeFor(const absl::Status& status);

}  // namespace eyebox

#define EYEBOX_STATUS_CONCAT_INNER(a, b) a##b
#define EYEBOX_STATUS_CONCAT(a, b) EYEBOX_STATUS_CONCAT_INNER(a, b)

#define EYEBOX_RETURN_IF_ERROR(expression)                                                       \
  do {                                                                                           \
    if (absl::Status eyebox_status_ = (expression); !eyebox_status_.ok()) return eyebox_status_; \
  } while (false)

#define EYEBOX_ASSIGN_OR_RETURN(declaration, expression) \
  EYEBOX_ASSIGN_OR_RETURN_IMPL(EYEBOX_STATUS_CONCAT(eyebox_or_, __LINE__), declaration, expression)

#define EYEBOX_ASSIGN_OR_RETURN_IMPL(result, declaration, expression) \
  auto result = (expression);                                         \
  if (!result.ok()) return std::move(result).status();                \
  declaration = *std::move(result)

#endif  // EYEBOX_CAPTURE_BASE_STATUS_H_
