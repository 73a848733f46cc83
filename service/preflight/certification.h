// What a preflight says of a recording: a failed one blocks certification, never capture.
#ifndef EYEBOX_SERVICE_PREFLIGHT_CERTIFICATION_H_
#define EYEBOX_SERVICE_PREFLIGHT_CERTIFICATION_H_

#include <filesystem>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/recording/header.h"
#include "eyebox/v1/preflight.pb.h"
#include "eyebox/v1/results.pb.h"

namespace eyebox::service {

// Stands beside recording.textproto.
inline constexpr char kPreflightFile[] = "preflight.json";

struct Certification {
  bool certified = false;
  std::string reason;
};

// Certified where kPreflightFile in `recording` holds a preflight of the same camera in which no
// check failed, and which covers every exposure that was planned. The reason also names the checks
// that were skipped. A file that cannot be read is a reason, no error.
Certification CertificationOf(const std::filesystem::path& recording,
                              const capture::RecordingHeader& header);

// Writes the message as DIR/preflight.json, whole or not at all; DIR is created if missing.
absl::Status WritePreflight(const std::filesystem::path& folder, const v1::PreflightResult& result);

// From a file, or from the folder that holds kPreflightFile.
// Errors: NotFound, InvalidArgument (holds something else).
absl::StatusOr<v1::PreflightResult> ReadPreflight(const std::filesystem::path& place);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_CERTIFICATION_H_
