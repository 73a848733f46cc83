#include "capture/run.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "capture/base/status.h"
#include "capture/base/version.h"
#include "capture/camera/camera_state.h"

namespace eyebox::capture {
namespace {

// Inside this file Aborted means: this attempt is spoilt, another one may succeed.
absl::Status Spoilt(const std::string& what) { return absl::AbortedError(what); }

std::string NameOf(BufferStatus status) {
  switch (status) {
    case BufferStatus::kComplete:
      return "is complete";
    case BufferStatus::kMissingPackets:
      return "misses packets";
    case BufferStatus::kTimedOut:
      return "timed out";
    case BufferStatus::kDeviceError:
      return "carries a device error";
    case BufferStatus::kAborted:
      return "was aborted";
  }
  return "has an unknown status";
}

bool SameExposure(double reported_s, double asked_s, double tolerance) {
  return std::abs(reported_s - asked_s) <= tolerance * asked_s;
}

constexpr double kGainToleranceDb = 1e-3;

absl::Status CheckReported(const FrameMetadata& metadata, const CaptureSpec& spec,
                           const RunOptions& options) {
  const std::string frame = "frame " + std::to_string(metadata.camera_frame_id);
  if (metadata.exposure_reported_s &&
      !SameExposure(*metadata.exposure_reported_s, spec.exposure_s, options.exposure_tolerance)) {
    return Spoilt(frame + " reports an exposure of " +
                  std::to_string(*metadata.exposure_reported_s) + " s instead of " +
                  std::to_string(spec.exposure_s) + " s");
  }
  if (metadata.gain_reported_db &&
      std::abs(*metadata.gain_reported_db - spec.gain_db) > kGainToleranceDb) {
    return Spoilt(frame + " reports a gain of " + std::to_string(*metadata.gain_reported_db) +
                  " dB instead of " + std::to_string(spec.gain_db) + " dB");
  }
  return absl::OkStatus();
}

absl::Status CheckPlan(const CameraInfo& info, const CapturePlan& plan) {
  if (plan.captures.empty()) return BadInput("plan", "holds no capture", "plan one or more");
  for (size_t i = 0; i < plan.captures.size(); ++i) {
    const CaptureSpec& spec = plan.captures[i];
    const std::string where = "plan, capture " + std::to_string(i + 1);
    if (spec.repeats < 1) {
      return BadInput(where, "asks for " + std::to_string(spec.repeats) + " frames",
                      "ask for one or more");
    }
    const absl::Status settings =
        CheckSettings(info, {.exposure_s = spec.exposure_s, .gain_db = spec.gain_db});
    if (!settings.ok()) {
      return absl::Status(settings.code(), where + ", " + std::string(settings.message()));
    }
  }
  return absl::OkStatus();
}

// One run in progress.
class PlanRunner {
 public:
  PlanRunner(Rig& rig, RecordingWriter& writer, const RunOptions& options)
      : camera_(*rig.camera), presenter_(*rig.presenter), writer_(writer), options_(options) {}

  // Takes capture `number` (from 1) until it is complete or the attempts are used up.
  absl::Status Take(int number, const CaptureSpec& spec) {
    absl::Status status;
    for (int attempt = 1; attempt <= options_.attempts; ++attempt) {
      status = Attempt(spec);
      if (!absl::IsAborted(status)) return status;
      ++report_.captures_taken_again;
    }
    return DeviceFailed(
        "capture " + std::to_string(number),
        "failed " + std::to_string(options_.attempts) + " times; the last time " +
            std::string(status.message()),
        "check cable, bandwidth and trigger of " + camera_.Info().uri + " and capture again");
  }

  const RunReport& report() const { return report_; }

 private:
  absl::Status Attempt(const CaptureSpec& spec) {
    EYEBOX_RETURN_IF_ERROR(camera_.Stop());
    EYEBOX_RETURN_IF_ERROR(Configure(spec));
    EYEBOX_RETURN_IF_ERROR(presenter_.Present(spec));
    EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<CaptureWriter> capture,
                            writer_.BeginCapture(spec, camera_.Info().sensor_size));
    EYEBOX_RETURN_IF_ERROR(camera_.Start());
    EYEBOX_RETURN_IF_ERROR(TakeFrames(spec, *capture));
    EYEBOX_RETURN_IF_ERROR(capture->Publish());
    ++report_.captures;
    report_.frames += spec.repeats;
    return absl::OkStatus();
  }

  absl::Status Configure(const CaptureSpec& spec) {
    const CameraSettings asked = {.exposure_s = spec.exposure_s, .gain_db = spec.gain_db};
    EYEBOX_ASSIGN_OR_RETURN(const CameraSettings set, camera_.Configure(asked));
    if (SameExposure(set.exposure_s, asked.exposure_s, options_.exposure_tolerance) &&
        std::abs(set.gain_db - asked.gain_db) <= kGainToleranceDb) {
      return absl::OkStatus();
    }
    return DeviceFailed(camera_.Info().uri,
                        "was asked for " + std::to_string(asked.exposure_s) + " s, " +
                            std::to_string(asked.gain_db) + " dB and reads back " +
                            std::to_string(set.exposure_s) + " s, " + std::to_string(set.gain_db) +
                            " dB",
                        "plan exposures and gains that the camera can hold");
  }

  absl::Status TakeFrames(const CaptureSpec& spec, CaptureWriter& capture) {
    std::optional<uint64_t> previous_id;
    for (int i = 0; i < spec.repeats; ++i) {
      if (options_.cancelled && options_.cancelled()) {
        return absl::CancelledError("the run was cancelled");
      }
      EYEBOX_ASSIGN_OR_RETURN(const Frame frame, TakeFrame(spec));
      EYEBOX_RETURN_IF_ERROR(CheckFrame(frame.metadata, spec, previous_id));
      EYEBOX_RETURN_IF_ERROR(capture.Append(frame));
      previous_id = frame.metadata.camera_frame_id;
      const bool last = i + 1 == spec.repeats;
      if (last || (i + 1) % options_.frames_per_acknowledgement == 0) {
        EYEBOX_RETURN_IF_ERROR(capture.Acknowledge());
      }
    }
    return absl::OkStatus();
  }

  absl::StatusOr<Frame> TakeFrame(const CaptureSpec& spec) {
    EYEBOX_RETURN_IF_ERROR(camera_.Trigger());
    const auto exposure = std::chrono::duration<double, std::milli>(spec.exposure_s * 1e3);
    const auto timeout =
        options_.frame_timeout + std::chrono::ceil<std::chrono::milliseconds>(exposure);
    absl::StatusOr<Frame> frame = camera_.NextFrame(timeout);
    if (!absl::IsDeadlineExceeded(frame.status())) return frame;
    return Spoilt("a triggered frame did not arrive (" + std::string(frame.status().message()) +
                  ")");
  }

  absl::Status CheckFrame(const FrameMetadata& metadata, const CaptureSpec& spec,
                          std::optional<uint64_t> previous_id) const {
    const uint64_t id = metadata.camera_frame_id;
    if (metadata.status != BufferStatus::kComplete) {
      return Spoilt("frame " + std::to_string(id) + " " + NameOf(metadata.status));
    }
    if (previous_id && id != *previous_id + 1) {
      return Spoilt("frame " + std::to_string(id) + " came after frame " +
                    std::to_string(*previous_id) + ": the frames between were dropped");
    }
    return CheckReported(metadata, spec, options_);
  }

  Camera& camera_;
  StimulusPresenter& presenter_;
  RecordingWriter& writer_;
  const RunOptions& options_;
  RunReport report_;
};

absl::Status RunCaptures(PlanRunner& runner, const CapturePlan& plan, const RunOptions& options) {
  const int total = static_cast<int>(plan.captures.size());
  for (int i = 0; i < total; ++i) {
    const CaptureSpec& spec = plan.captures[static_cast<size_t>(i)];
    if (options.progress) options.progress({i, total, spec});
    EYEBOX_RETURN_IF_ERROR(runner.Take(i + 1, spec));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status RunOptions::Validate() const {
  if (attempts < 1) return BadInput("RunOptions.attempts", "is below 1", "allow one or more");
  if (frames_per_acknowledgement < 1) {
    return BadInput("RunOptions.frames_per_acknowledgement", "is below 1", "give one or more");
  }
  if (exposure_tolerance >= 0 && exposure_tolerance < 1) return absl::OkStatus();
  return BadInput("RunOptions.exposure_tolerance", "is " + std::to_string(exposure_tolerance),
                  "give a fraction from 0 up to 1");
}

RecordingHeader MakeHeader(const Rig& rig, const CapturePlan& plan, const Clock& clock) {
  RecordingHeader header;
  header.origin = rig.origin;
  header.rig = rig.config;
  header.camera = rig.camera->Info();
  header.geometry = rig.camera->Info().geometry;
  header.plan = plan;
  header.software_version = std::string(kVersion);
  header.created_real_ns = clock.RealNs();
  return header;
}

absl::StatusOr<RunReport> RunPlan(Rig& rig, const CapturePlan& plan, RecordingWriter& writer,
                                  const RunOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckPlan(rig.camera->Info(), plan));
  PlanRunner runner(rig, writer, options);
  const absl::Status run = RunCaptures(runner, plan, options);
  const absl::Status stop = rig.camera->Stop();
  if (!run.ok()) return run;
  if (!stop.ok()) return stop;
  return runner.report();
}

}  // namespace eyebox::capture
