// Captures a plan into a new recording.
#ifndef EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_
#define EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "capture/run.h"
#include "service/watcher.h"

namespace eyebox::service {

// `recording` must not exist. Captures that were published before an error stay.
// Errors: those of RecordingWriter::Create() and of RunPlan().
absl::StatusOr<capture::RunReport> RecordPlan(capture::Rig& rig, const CapturePlan& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_
