// A capture plan as a file: the message eyebox.v1.CapturePlan as textproto.
#ifndef EYEBOX_CAPTURE_RECORDING_PLAN_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_PLAN_FILE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"

namespace eyebox::capture {

// Errors: those of ReadWholeFile; InvalidArgument (file, line and field named; no capture).
absl::StatusOr<CapturePlan> ReadPlanFile(const std::filesystem::path& file);

// Errors: the errno of the disk.
absl::Status WritePlanFile(const CapturePlan& plan, const std::filesystem::path& file);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_PLAN_FILE_H_
