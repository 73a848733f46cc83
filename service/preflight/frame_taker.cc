#include "service/preflight/frame_taker.h"

#include <chrono>
#include <string>
#include <utility>

#include "capture/base/status.h"

namespace eyebox::service {
namespace {

constexpr int kAttempts = 3;
constexpr std::chrono::milliseconds kFrameTimeout(5000);  // beyond the exposure

capture::CameraSettings SettingsFor(const capture::CameraInfo& info, double exposure_s) {
  capture::CameraSettings settings = {.exposure_s = exposure_s};
  if (!info.software_trigger && info.free_run) settings.trigger = capture::TriggerSource::kFreeRun;
  return settings;
}

}  // namespace

absl::Status FrameTaker::ShowDark() {
  CaptureSpec spec;
  spec.kind = FrameKind::kDark;
  return rig_.presenter->Present(spec);
}

absl::Status FrameTaker::ShowGrey(double drive) {
  CaptureSpec spec;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  return rig_.presenter->Present(spec);
}

absl::Status FrameTaker::Set(double exposure_s) {
  EYEBOX_RETURN_IF_ERROR(rig_.camera->Stop());
  const capture::CameraSettings asked = SettingsFor(info(), exposure_s);
  EYEBOX_ASSIGN_OR_RETURN(const capture::CameraSettings reported, rig_.camera->Configure(asked));
  read_backs_.push_back({asked, reported});
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Counts>> FrameTaker::TakeFirst(double exposure_s, int count) {
  EYEBOX_RETURN_IF_ERROR(Set(exposure_s));
  EYEBOX_RETURN_IF_ERROR(rig_.camera->Start());
  std::vector<Counts> frames;
  for (int i = 0; i < count; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(Counts counts, TakeOne(exposure_s));
    frames.push_back(std::move(counts));
  }
  return frames;
}

absl::StatusOr<std::vector<Counts>> FrameTaker::TakeSettled(double exposure_s, int count) {
  EYEBOX_RETURN_IF_ERROR(TakeFirst(exposure_s, settle_frames_).status());
  std::vector<Counts> frames;
  for (int i = 0; i < count; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(Counts counts, TakeOne(exposure_s));
    frames.push_back(std::move(counts));
  }
  return frames;
}

absl::StatusOr<Counts> FrameTaker::TakeOne(double exposure_s) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    EYEBOX_ASSIGN_OR_RETURN(const Frame frame, NextFrame(exposure_s));
    if (frame.metadata.status != BufferStatus::kComplete) continue;
    return Counts(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
  }
  return DeviceFailed(info().uri, "sent three incomplete frames in a row",
                      "check cable and bandwidth and run the preflight again");
}

absl::StatusOr<Frame> FrameTaker::NextFrame(double exposure_s) {
  if (read_backs_.back().asked.trigger == capture::TriggerSource::kSoftware) {
    EYEBOX_RETURN_IF_ERROR(rig_.camera->Trigger());
  }
  const auto exposure = std::chrono::duration<double, std::milli>(exposure_s * 1e3);
  auto frame = rig_.camera->NextFrame(kFrameTimeout +
                                      std::chrono::ceil<std::chrono::milliseconds>(exposure));
  if (!absl::IsDeadlineExceeded(frame.status())) return frame;
  return DeviceFailed(info().uri, "sent no frame: " + std::string(frame.status().message()),
                      "check trigger, cable and bandwidth");
}

}  // namespace eyebox::service
