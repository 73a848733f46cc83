#include "capture/base/status.h"

#include <cstring>

namespace eyebox {

std::string Complaint(std::string_view where, std::string_view what, std::string_view remedy) {
  std::string message(where);
  message.append(": ").append(what);
  if (!remedy.empty()) message.append("; ").append(remedy);
  return message;
}

absl::Status BadInput(std::string_view where, std::string_view what, std::string_view remedy) {
  return absl::InvalidArgumentError(Complaint(where, what, remedy));
}

absl::Status Missing(std::string_view where, std::string_view what, std::string_view remedy) {
  return absl::NotFoundError(Complaint(where, what, remedy));
}

absl::Status Corrupt(std::string_view where, std::string_view what, std::string_view remedy) {
  return absl::DataLossError(Complaint(where, what, remedy));
}

absl::Status DeviceFailed(std::string_view where, std::string_view what, std::string_view remedy) {
  return absl::UnavailableError(Complaint(where, what, remedy));
}

absl::Status Rejected(std::string_view where, std::string_view what, std::string_view remedy) {
  return absl::FailedPreconditionError(Complaint(where, what, remedy));
}

absl::Status SystemFailed(std::string_view where, int error_number, std::string_view remedy) {
  const absl::StatusCode code = absl::ErrnoToStatusCode(error_number);
  return absl::Status(code, Complaint(where, std::strerror(error_number), remedy));
}

int ExitCodeFor(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return 0;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return 4;
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kAborted:
      return 5;
    default:
      return 3;
  }
}

}  // namespace eyebox
