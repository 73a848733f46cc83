#include "capture/camera/aravis/aravis_rig.h"

#include <memory>
#include <utility>

#include "capture/base/status.h"
#include "capture/camera/aravis/acquisition.h"
#include "capture/camera/aravis/command_thread.h"
#include "capture/camera/camera_state.h"
#include "capture/camera/manual_presenter.h"

namespace eyebox::capture {
namespace {

using aravis::Acquisition;
using aravis::CommandThread;

// Checks that a call is allowed, then has it done in the thread that owns the camera.
class AravisCamera final : public Camera {
 public:
  AravisCamera(std::unique_ptr<CommandThread> thread, std::unique_ptr<Acquisition> acquisition)
      : thread_(std::move(thread)),
        acquisition_(std::move(acquisition)),
        state_(acquisition_->info().uri) {}

  ~AravisCamera() override {
    thread_->Run([this] {
      acquisition_->Stop().IgnoreError();  // who destroys a camera asks for nothing any more
      acquisition_.reset();
    });
  }

  const CameraInfo& Info() const override { return acquisition_->info(); }

  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.Configure(Info(), settings));
    return thread_->Run([&] { return acquisition_->Configure(settings); });
  }

  absl::Status Start() override {
    EYEBOX_RETURN_IF_ERROR(state_.Start());
    const absl::Status started = thread_->Run([&] { return acquisition_->Start(); });
    if (!started.ok()) state_.Stop();
    running_ = started.ok();
    return started;
  }

  absl::Status Trigger() override {
    EYEBOX_RETURN_IF_ERROR(state_.Trigger());
    return thread_->Run([&] { return acquisition_->Trigger(); });
  }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
    if (!running_) {
      return Rejected(Info().uri, "was asked for a frame while stopped", "start it first");
    }
    return thread_->Run([&] { return acquisition_->NextFrame(timeout); });
  }

  absl::Status Stop() override {
    state_.Stop();
    running_ = false;
    return thread_->Run([&] { return acquisition_->Stop(); });
  }

 private:
  const std::unique_ptr<CommandThread> thread_;
  std::unique_ptr<Acquisition> acquisition_;
  CameraState state_;
  bool running_ = false;
};

}  // namespace

std::vector<CameraInfo> ListAravisCameras() {
  CommandThread thread;
  std::vector<CameraInfo> cameras;
  for (aravis::DeviceListing& device : thread.Run(aravis::ListDevices)) {
    CameraInfo info;
    info.uri = "aravis:" + device.id;
    info.vendor = std::move(device.vendor);
    info.model = std::move(device.model);
    info.serial = std::move(device.serial);
    cameras.push_back(std::move(info));
  }
  return cameras;
}

absl::StatusOr<Rig> OpenAravisRig(const RigConfig& config, const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const aravis::AravisOptions options,
                          aravis::ParseAravisUri(config.camera_uri));
  auto thread = std::make_unique<CommandThread>();
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<Acquisition> acquisition,
                          thread->Run([&] { return Acquisition::Open(options, clock); }));
  Rig rig;
  rig.config = config;
  rig.origin = options.fake ? RecordingOrigin::kSimulated : RecordingOrigin::kCaptured;
  rig.camera = std::make_unique<AravisCamera>(std::move(thread), std::move(acquisition));
  rig.presenter = std::make_unique<ManualPresenter>();
  return rig;
}

}  // namespace eyebox::capture
