// A headset that warms up, glows after, sleeps or dims: wraps the presenter and the camera of a
// rig.
#ifndef EYEBOX_TESTS_SUPPORT_RESTLESS_DISPLAY_H_
#define EYEBOX_TESTS_SUPPORT_RESTLESS_DISPLAY_H_

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "capture/base/clock.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

// What the display does to a count above the dark: multiplies it, adds a glow.
struct DisplayFault {
  double factor = 1;
  double glow_dn = 0;
};

// What is asked about: how many lights were presented, and for how long the present one stands.
struct DisplayMoment {
  int lights_presented = 0;
  int64_t shown_for_ns = 0;
  int64_t now_ns = 0;
  CaptureSpec spec;
  CaptureSpec before;  // the light before this one
};

using DisplayFaultOf = std::function<DisplayFault(const DisplayMoment&)>;

// Shared by the two wrappers.
struct RestlessDisplay {
  DisplayFaultOf fault;
  ManualClock* clock = nullptr;
  double bias_dn = 0;             // counts of the dark, which no fault changes
  int saturated_dn = 4095;        // counts that stay there
  int64_t frame_ns = 10'000'000;  // that the clock advances by each exposure
  int64_t presented_ns = 0;
  DisplayMoment moment = {};
};

class RestlessPresenter final : public StimulusPresenter {
 public:
  RestlessPresenter(std::unique_ptr<StimulusPresenter> presenter,
                    std::shared_ptr<RestlessDisplay> display)
      : presenter_(std::move(presenter)), display_(std::move(display)) {}

  absl::Status Present(const CaptureSpec& spec) override {
    DisplayMoment& moment = display_->moment;
    const bool light = spec.kind == FrameKind::kLight;
    if (light && moment.spec.stimulus != spec.stimulus) {
      moment.before = moment.spec;
      display_->presented_ns = display_->clock->MonotonicNs();
    }
    moment.lights_presented += light ? 1 : 0;
    moment.spec = spec;
    return presenter_->Present(spec);
  }

 private:
  const std::unique_ptr<StimulusPresenter> presenter_;
  const std::shared_ptr<RestlessDisplay> display_;
};

class RestlessCamera final : public Camera {
 public:
  RestlessCamera(std::unique_ptr<Camera> camera, std::shared_ptr<RestlessDisplay> display)
      : camera_(std::move(camera)), display_(std::move(display)) {}

  const CameraInfo& Info() const override { return camera_->Info(); }
  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    return camera_->Configure(settings);
  }
  absl::Status Start() override { return camera_->Start(); }
  absl::Status Trigger() override {
    display_->clock->AdvanceNs(display_->frame_ns);
    return camera_->Trigger();
  }
  absl::Status Stop() override { return camera_->Stop(); }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
    absl::StatusOr<Frame> frame = camera_->NextFrame(timeout);
    if (!frame.ok()) return frame;
    frame->metadata.device_time_ns.reset();  // the clock of the test is the only one
    if (display_->moment.spec.kind == FrameKind::kLight) Spoil(*frame);
    return frame;
  }

 private:
  void Spoil(Frame& frame) const {
    DisplayMoment& moment = display_->moment;
    moment.now_ns = display_->clock->MonotonicNs();
    moment.shown_for_ns = moment.now_ns - display_->presented_ns;
    const DisplayFault fault = display_->fault(moment);
    auto counts = std::make_shared<std::vector<uint16_t>>();
    for (const uint16_t count : frame.view.pixels_dn) {
      if (count >= display_->saturated_dn) {
        counts->push_back(count);
        continue;
      }
      const double dn =
          display_->bias_dn + fault.factor * (count - display_->bias_dn) + fault.glow_dn;
      counts->push_back(static_cast<uint16_t>(std::clamp(std::lround(dn), 0L, 65535L)));
    }
    frame.view.pixels_dn = *counts;
    frame.owner = std::move(counts);
  }

  const std::unique_ptr<Camera> camera_;
  const std::shared_ptr<RestlessDisplay> display_;
};

// Puts both into `rig`, which runs by `clock`.
inline void MakeRestless(Rig& rig, ManualClock& clock, double bias_dn, DisplayFaultOf fault) {
  auto display = std::make_shared<RestlessDisplay>();
  display->fault = std::move(fault);
  display->clock = &clock;
  display->bias_dn = bias_dn;
  rig.presenter = std::make_unique<RestlessPresenter>(std::move(rig.presenter), display);
  rig.camera = std::make_unique<RestlessCamera>(std::move(rig.camera), std::move(display));
}

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_SUPPORT_RESTLESS_DISPLAY_H_
