// Captures a plan into a recording, new or interrupted.
#ifndef EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_
#define EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/writer.h"
#include "capture/run.h"
#include "service/watcher.h"

namespace eyebox::service {

// Whether frames come from a device, so that a scene takes time and a camera may be lost.
bool MeasuresWithDevice(const capture::Rig& rig);

// Empty: as SettleOptions() has it with a device, not at all otherwise. A replay never settles: it
// has no frames to spare.
using Settle = std::optional<capture::SettleOptions>;

// `recording` must not exist. Captures that were published before an error stay. With a device the
// camera is opened anew where it is lost. How each capture went stands in CaptureLogPath().
// Errors: those of RecordingWriter::Create() and of RunPlan().
absl::StatusOr<capture::RunReport> RecordPlan(capture::Rig& rig, const CapturePlan& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher, const Settle& settle = {});

// Recovers what a crash left and takes the captures that are still to be taken, suspect ones
// included; the report counts those alone. With nothing left to take it has no capture.
// Errors: those of RecoverRecording() and of RunPlan(); InvalidArgument (the recording was made
// with another rig or camera, or it follows another plan than `plan`, where one is given: says
// what differs).
absl::StatusOr<capture::RunReport> ResumePlan(capture::Rig& rig,
                                              const std::optional<CapturePlan>& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher, const Settle& settle = {});

// Captures one after the other, each when it is asked for.
class CaptureSession {
 public:
  // As RecordPlan() and ResumePlan() with the same arguments; `plan` is only written down and may
  // be empty. `rig` must outlive the session.
  static absl::StatusOr<std::unique_ptr<CaptureSession>> Begin(
      capture::Rig& rig, const CapturePlan& plan, const std::filesystem::path& recording,
      const Settle& settle = {});
  static absl::StatusOr<std::unique_ptr<CaptureSession>> Resume(
      capture::Rig& rig, const std::filesystem::path& recording, const Settle& settle = {});

  // Whole captures on stable storage, suspect ones included. Captures of a session are counted by
  // these: one that a kill cut short stays in the recording and is taken again under its number.
  int Published() const { return static_cast<int>(recorded_.size()); }
  // What one of them read; nothing if it is suspect.
  std::optional<capture::Reading> ReadingOf(int number) const;

  // The next capture, on stable storage when this returns. Errors: those of RunPlan().
  absl::StatusOr<capture::CaptureFigures> Take(const CaptureSpec& spec, const Watcher& watcher);

 private:
  CaptureSession(capture::Rig& rig, std::filesystem::path recording, Settle settle)
      : rig_(rig), recording_(std::move(recording)), settle_(std::move(settle)) {}

  capture::Rig& rig_;
  const std::filesystem::path recording_;
  const Settle settle_;
  std::unique_ptr<capture::RecordingWriter> writer_;
  std::vector<capture::Reading> readings_;  // by their numbers in the recording
  std::vector<int> recorded_;  // number in the recording of each capture of the session
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_RECORD_PLAN_H_
