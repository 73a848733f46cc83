#include "service/server/preview/preview_hub.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "capture/base/clock.h"
#include "capture/base/status.h"

namespace eyebox::service {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kPeriod{100};
constexpr std::chrono::seconds kStaysOpen{2};
constexpr std::chrono::seconds kPatience{5};  // beyond the exposure

bool IsSimulated(const capture::RigConfig& rig) { return rig.camera_uri.starts_with("sim:"); }

absl::StatusOr<capture::Rig> Open(const PreviewView& view) {
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(view.rig, SystemClock()));
  if (view.drive) {
    if (!IsSimulated(view.rig)) {
      return BadInput("drive", "is given, and only a simulated headset shows what it is told",
                      "leave it out");
    }
    CaptureSpec spec;
    spec.stimulus.drive = DriveRgb{*view.drive, *view.drive, *view.drive};
    EYEBOX_RETURN_IF_ERROR(rig.presenter->Present(spec));
  }
  capture::CameraSettings settings;
  settings.exposure_s = view.exposure_s;
  settings.gain_db = view.gain_db;
  if (!rig.camera->Info().software_trigger) settings.trigger = capture::TriggerSource::kFreeRun;
  EYEBOX_RETURN_IF_ERROR(rig.camera->Configure(settings).status());
  EYEBOX_RETURN_IF_ERROR(rig.camera->Start());
  return rig;
}

absl::StatusOr<Frame> Take(capture::Rig& rig, double exposure_s) {
  if (rig.camera->Info().software_trigger) EYEBOX_RETURN_IF_ERROR(rig.camera->Trigger());
  return rig.camera->NextFrame(kPatience + milliseconds(static_cast<int64_t>(1000 * exposure_s)));
}

}  // namespace

bool IsSame(const PreviewView& a, const PreviewView& b) {
  return a.rig.name == b.rig.name && a.rig.camera_uri == b.rig.camera_uri &&
         a.rig.seed == b.rig.seed && a.exposure_s == b.exposure_s && a.gain_db == b.gain_db &&
         a.most_width_px == b.most_width_px && a.drive == b.drive;
}

absl::Status PreviewHub::Obstacle() const {
  if (stopped_) {
    return absl::UnavailableError(Complaint("server", "is stopping", "ask again once it is up"));
  }
  if (held_by_.empty()) return absl::OkStatus();
  return Rejected("preview", held_by_.front() + " captures, and nothing may disturb it",
                  "wait for it to end, or cancel it");
}

absl::StatusOr<PreviewViewer> PreviewHub::Look(const PreviewView& view,
                                               PreviewLook::Listener listener) {
  std::unique_lock lock(mutex_);
  EYEBOX_RETURN_IF_ERROR(Obstacle());
  if (look_ && !ending_ && IsSame(view, view_)) {
    return PreviewViewer{look_, look_->Listen(std::move(listener))};
  }
  if (look_ && look_->Unwatched() == std::chrono::steady_clock::duration::zero()) {
    return Rejected("preview", "someone looks at " + view_.rig.name + " already, or otherwise",
                    "ask for the same exposure, gain, width and drive, or wait");
  }
  EndLook(lock);
  EYEBOX_RETURN_IF_ERROR(Obstacle());
  if (look_) return Rejected("preview", "another one has just begun", "ask again");
  view_ = view;
  look_ = std::make_shared<PreviewLook>();
  PreviewViewer viewer{look_, look_->Listen(std::move(listener))};
  if (thread_.joinable()) thread_.join();  // it ended when it let go of the camera
  thread_ = std::thread([this, view, look = look_] { TakePictures(view, *look); });
  return viewer;
}

void PreviewHub::EndLook(std::unique_lock<std::mutex>& lock) {
  if (!look_) return;
  ending_ = true;
  changed_.notify_all();
  changed_.wait(lock, [this] { return look_ == nullptr; });
}

void PreviewHub::TakePictures(const PreviewView& view, PreviewLook& look) {
  absl::Status status = ShowPictures(view, look);
  {
    const std::lock_guard lock(mutex_);
    if (status.ok()) status = Obstacle();
    if (status.ok()) status = absl::CancelledError("nobody looked any more");
    ending_ = false;
    look_ = nullptr;
    changed_.notify_all();
  }
  look.End(status);
}

// The camera is closed when it returns.
absl::Status PreviewHub::ShowPictures(const PreviewView& view, PreviewLook& look) {
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, Open(view));
  const int bits = rig.camera->Info().significant_bits;
  while (GoesOn(look)) {
    EYEBOX_ASSIGN_OR_RETURN(const Frame frame, Take(rig, view.exposure_s));
    if (frame.metadata.status != BufferStatus::kComplete) continue;
    look.Publish(PictureOf(frame, bits, view.most_width_px));
  }
  return rig.camera->Stop();
}

bool PreviewHub::GoesOn(const PreviewLook& look) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kPeriod, [this] { return ending_; });
  return !ending_ && look.Unwatched() < kStaysOpen;
}

PreviewHub::Hold::Hold(PreviewHub& hub, const std::string& job) : hub_(hub), job_(job) {
  std::unique_lock lock(hub_.mutex_);
  hub_.held_by_.push_back(job_);
  hub_.EndLook(lock);
}

PreviewHub::Hold::~Hold() {
  const std::lock_guard lock(hub_.mutex_);
  hub_.held_by_.erase(std::ranges::find(hub_.held_by_, job_));
}

void PreviewHub::Stop() {
  {
    std::unique_lock lock(mutex_);
    stopped_ = true;
    EndLook(lock);
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace eyebox::service
