#include "capture/run/attempt.h"

#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/run/frame_check.h"

namespace eyebox::capture {

CameraSettings StateOf(const Rig& rig) {
  CameraSettings state;
  if (!rig.trigger || rig.config.camera_trigger_line.empty()) return state;
  state.trigger = TriggerSource::kLine;
  state.trigger_line = rig.config.camera_trigger_line;
  return state;
}

absl::StatusOr<TakenCapture> CaptureTaker::Attempt(const CaptureSpec& spec) {
  EYEBOX_RETURN_IF_ERROR(FromCamera(rig_.camera->Stop()));
  EYEBOX_RETURN_IF_ERROR(Configure(spec));
  EYEBOX_RETURN_IF_ERROR(samples_.Prepare());
  EYEBOX_RETURN_IF_ERROR(rig_.presenter->Present(spec));
  TakenCapture taken;
  EYEBOX_ASSIGN_OR_RETURN(taken.writer, writer_.BeginCapture(spec, rig_.camera->Info().sensor_size,
                                                             samples_.RoomFor(spec)));
  EYEBOX_RETURN_IF_ERROR(FromCamera(rig_.camera->Start()));
  EYEBOX_ASSIGN_OR_RETURN(taken.settling, Settle(spec));
  EYEBOX_RETURN_IF_ERROR(samples_.Begin(*taken.writer));
  EYEBOX_ASSIGN_OR_RETURN(taken.mean, TakeFrames(spec, *taken.writer));
  taken.samples = samples_.samples();
  return taken;
}

absl::Status CaptureTaker::Configure(const CaptureSpec& spec) {
  CameraSettings asked = StateOf(rig_);
  asked.exposure_s = spec.exposure_s;
  asked.gain_db = spec.gain_db;
  const absl::StatusOr<CameraSettings> set = rig_.camera->Configure(asked);
  EYEBOX_RETURN_IF_ERROR(FromCamera(set.status()));
  return CheckReadBack(asked, *set, rig_.camera->Info().uri, options_.exposure_tolerance);
}

// A covered lens has nothing to settle, and neither has the next exposure of a bracket.
bool CaptureTaker::IsSettledOn(const CaptureSpec& spec) const {
  return spec.kind == FrameKind::kDark ||
         (settled_on_ && settled_on_->kind == spec.kind && settled_on_->stimulus == spec.stimulus &&
          settled_on_->luminance_cd_m2 == spec.luminance_cd_m2);
}

absl::StatusOr<std::optional<Settling>> CaptureTaker::Settle(const CaptureSpec& spec) {
  if (!options_.settle || IsSettledOn(spec)) {
    settled_on_ = spec;
    return std::nullopt;
  }
  SettleWatch watch(*options_.settle);
  for (bool done = false; !done;) {
    EYEBOX_ASSIGN_OR_RETURN(const Frame frame, TakeFrame(spec));
    const bool counts =
        CheckFrame(frame.metadata, spec, std::nullopt, options_.exposure_tolerance).ok();
    done = counts ? watch.Add(frame.metadata, MeanOf(frame.view)) : watch.Skip();
  }
  settled_on_ = spec;
  return watch.Result();
}

absl::StatusOr<FrameMean> CaptureTaker::TakeFrames(const CaptureSpec& spec,
                                                   CaptureWriter& capture) {
  std::optional<uint64_t> previous_id;
  std::vector<FrameMean> means;
  for (int i = 0; i < spec.repeats; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const Frame frame, TakeFrame(spec));
    EYEBOX_RETURN_IF_ERROR(
        CheckFrame(frame.metadata, spec, previous_id, options_.exposure_tolerance));
    EYEBOX_RETURN_IF_ERROR(capture.Append(frame));
    means.push_back(MeanOf(frame.view));
    previous_id = frame.metadata.camera_frame_id;
    const bool last = i + 1 == spec.repeats;
    EYEBOX_RETURN_IF_ERROR(last ? samples_.Finish(spec, frame.metadata.monotonic_time_ns, capture)
                                : samples_.Drain(capture));
    if (last || (i + 1) % options_.frames_per_acknowledgement == 0) {
      EYEBOX_RETURN_IF_ERROR(capture.Acknowledge());
    }
  }
  return MeanOf(means);
}

absl::StatusOr<Frame> CaptureTaker::TakeFrame(const CaptureSpec& spec) {
  if (options_.cancelled && options_.cancelled()) {
    return absl::CancelledError("the run was cancelled");
  }
  EYEBOX_ASSIGN_OR_RETURN(const std::optional<int64_t> pulse_ns, StartExposure());
  const auto exposure = std::chrono::duration<double, std::milli>(spec.exposure_s * 1e3);
  const auto timeout =
      options_.frame_timeout + std::chrono::ceil<std::chrono::milliseconds>(exposure);
  absl::StatusOr<Frame> frame = rig_.camera->NextFrame(timeout);
  if (absl::IsDeadlineExceeded(frame.status())) {
    return Spoilt("a triggered frame did not arrive (" + std::string(frame.status().message()) +
                  ")");
  }
  EYEBOX_RETURN_IF_ERROR(FromCamera(frame.status()));
  if (pulse_ns) frame->metadata.trigger_time_ns = pulse_ns;
  return frame;
}

absl::StatusOr<std::optional<int64_t>> CaptureTaker::StartExposure() {
  std::optional<int64_t> pulse_ns;
  if (rig_.trigger) {
    const absl::StatusOr<Pulse> pulse = rig_.trigger->Fire(options_.trigger_pulse);
    if (absl::IsUnavailable(pulse.status())) {
      return Spoilt("the trigger failed (" + std::string(pulse.status().message()) + ")");
    }
    EYEBOX_RETURN_IF_ERROR(pulse.status());
    pulse_ns = std::midpoint(pulse->on.before_ns, pulse->on.after_ns);
  }
  if (StateOf(rig_).trigger == TriggerSource::kLine) return pulse_ns;
  EYEBOX_RETURN_IF_ERROR(FromCamera(rig_.camera->Trigger()));
  return std::nullopt;
}

absl::Status CaptureTaker::FromCamera(absl::Status status) {
  camera_lost_ |= absl::IsUnavailable(status);
  return status;
}

}  // namespace eyebox::capture
