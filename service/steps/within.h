// Tells in which recording something went wrong.
#ifndef EYEBOX_SERVICE_STEPS_WITHIN_H_
#define EYEBOX_SERVICE_STEPS_WITHIN_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace eyebox::service {

// The status with the recording's path in front, unless its message names it already.
inline absl::Status Within(const std::filesystem::path& recording, const absl::Status& status) {
  if (status.ok() || absl::IsCancelled(status) ||
      absl::StrContains(status.message(), recording.string())) {
    return status;
  }
  return absl::Status(status.code(), absl::StrCat(recording.string(), ": ", status.message()));
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_WITHIN_H_
