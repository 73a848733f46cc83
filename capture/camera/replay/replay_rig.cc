#include "capture/camera/replay/replay_rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/camera/camera_state.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kScheme = "replay:";

bool SameSettings(const CaptureSpec& recorded, double exposure_s, double gain_db) {
  return std::abs(recorded.exposure_s - exposure_s) <= 1e-9 * recorded.exposure_s &&
         std::abs(recorded.gain_db - gain_db) <= 1e-9;
}

bool Matches(const CaptureSpec& recorded, const CaptureSpec& asked) {
  return recorded.kind == asked.kind && recorded.series == asked.series &&
         recorded.level_id == asked.level_id && recorded.stimulus == asked.stimulus &&
         SameSettings(recorded, asked.exposure_s, asked.gain_db);
}

std::string Describe(const CaptureSpec& spec) {
  const std::string kind = spec.kind == FrameKind::kDark   ? "dark"
                           : spec.kind == FrameKind::kFlat ? "flat"
                                                           : "light";
  return "a " + kind + " of series '" + spec.series + "', level " + std::to_string(spec.level_id) +
         ", exposure " + std::to_string(spec.exposure_s) + " s, gain " +
         std::to_string(spec.gain_db) + " dB";
}

// What camera and presenter share: the recording and the place in it.
class Tape {
 public:
  explicit Tape(std::unique_ptr<RecordingReader> reader)
      : reader_(std::move(reader)), times_shown_(reader_->Captures().size(), 0) {}

  const RecordingHeader& Header() const { return reader_->Header(); }

  absl::Status Seek(const CaptureSpec& spec) {
    const std::span<const CaptureEntry> captures = reader_->Captures();
    const CaptureEntry* found = nullptr;
    for (const CaptureEntry& capture : captures) {
      if (!capture.suspect.empty() || !Matches(capture.spec, spec)) continue;
      if (!found || TimesShown(capture) < TimesShown(*found)) found = &capture;
    }
    if (!found) {
      return Missing("the replayed recording", "holds no capture like " + Describe(spec),
                     "replay the plan that was recorded");
    }
    ++TimesShown(*found);
    current_ = found;
    frames_.clear();
    next_frame_ = 0;
    return absl::OkStatus();
  }

  absl::Status CheckSettings(const CameraSettings& settings) const {
    if (!current_) {
      return Rejected("the replay camera", "was triggered before anything was presented",
                      "present a capture of the recording first");
    }
    if (SameSettings(current_->spec, settings.exposure_s, settings.gain_db)) {
      return absl::OkStatus();
    }
    return Rejected(current_->file.string(),
                    "was recorded as " + Describe(current_->spec) + ", the camera is set to " +
                        std::to_string(settings.exposure_s) + " s and " +
                        std::to_string(settings.gain_db) + " dB",
                    "configure the exposure and gain of the capture that is presented");
  }

  absl::StatusOr<Frame> NextFrame() {
    if (next_frame_ >= current_->frame_count) {
      return DeviceFailed(
          current_->file.string(),
          "holds " + std::to_string(current_->frame_count) + " frames, no more can be replayed",
          "ask for as many repeats as were recorded");
    }
    if (frames_.empty()) EYEBOX_RETURN_IF_ERROR(LoadCapture());
    return frames_[static_cast<size_t>(next_frame_++)];
  }

 private:
  int& TimesShown(const CaptureEntry& capture) {
    return times_shown_[static_cast<size_t>(&capture - reader_->Captures().data())];
  }

  // The reader shows its frames through one buffer; they are copied to outlive it.
  absl::Status LoadCapture() {
    std::vector<Frame> frames;
    EYEBOX_RETURN_IF_ERROR(reader_->VisitFrames(*current_, [&frames](const Frame& frame) {
      auto counts_dn = std::make_shared<const std::vector<uint16_t>>(frame.view.pixels_dn.begin(),
                                                                     frame.view.pixels_dn.end());
      const FrameView view = {.pixels_dn = *counts_dn, .size = frame.view.size};
      frames.push_back({.metadata = frame.metadata, .view = view, .owner = std::move(counts_dn)});
      return absl::OkStatus();
    }));
    frames_ = std::move(frames);
    return absl::OkStatus();
  }

  const std::unique_ptr<RecordingReader> reader_;
  std::vector<int> times_shown_;
  const CaptureEntry* current_ = nullptr;
  std::vector<Frame> frames_;  // of the current capture, empty until the first is asked for
  int next_frame_ = 0;
};

class ReplayCamera final : public Camera {
 public:
  ReplayCamera(CameraInfo info, std::shared_ptr<Tape> tape)
      : info_(std::move(info)), state_(info_.uri), tape_(std::move(tape)) {}

  const CameraInfo& Info() const override { return info_; }

  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.Configure(info_, settings));
    return state_.settings();
  }

  absl::Status Start() override { return state_.Start(); }

  absl::Status Trigger() override {
    EYEBOX_RETURN_IF_ERROR(tape_->CheckSettings(state_.settings()));
    return state_.Trigger();
  }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds) override {
    EYEBOX_RETURN_IF_ERROR(state_.TakePending());
    return tape_->NextFrame();
  }

  absl::Status Stop() override {
    state_.Stop();
    return absl::OkStatus();
  }

 private:
  const CameraInfo info_;
  CameraState state_;
  const std::shared_ptr<Tape> tape_;
};

class ReplayPresenter final : public StimulusPresenter {
 public:
  explicit ReplayPresenter(std::shared_ptr<Tape> tape) : tape_(std::move(tape)) {}
  absl::Status Present(const CaptureSpec& spec) override { return tape_->Seek(spec); }

 private:
  const std::shared_ptr<Tape> tape_;
};

}  // namespace

absl::StatusOr<Rig> OpenReplayRig(const RigConfig& config, const Clock*) {
  const std::filesystem::path folder = config.camera_uri.substr(kScheme.size());
  if (folder.empty()) {
    return BadInput(config.camera_uri, "names no recording", "give a URI like replay:recordings/a");
  }
  EYEBOX_ASSIGN_OR_RETURN(auto reader, RecordingReader::Open(folder));
  auto tape = std::make_shared<Tape>(std::move(reader));
  CameraInfo info = tape->Header().camera;
  info.uri = config.camera_uri;
  info.geometry = tape->Header().geometry;
  Rig rig;
  rig.config = config;
  rig.origin = tape->Header().origin;
  rig.camera = std::make_unique<ReplayCamera>(std::move(info), tape);
  rig.presenter = std::make_unique<ReplayPresenter>(std::move(tape));
  return rig;
}

}  // namespace eyebox::capture
