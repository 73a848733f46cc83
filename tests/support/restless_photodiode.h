// A photodiode that looks at the restless display, beside the camera.
#ifndef EYEBOX_TESTS_SUPPORT_RESTLESS_PHOTODIODE_H_
#define EYEBOX_TESTS_SUPPORT_RESTLESS_PHOTODIODE_H_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "capture/base/clock.h"
#include "capture/base/random.h"
#include "capture/camera/rig.h"
#include "capture/photodiode/photodiode.h"

namespace eyebox::capture {

// Counts above the zero, without noise, of what is shown at a time.
using LightAt = std::function<double(const CaptureSpec& shown, int64_t now_ns)>;

// Shared with the presenter, which notes what is shown.
struct ShownNow {
  CaptureSpec spec;
};

class NotingPresenter final : public StimulusPresenter {
 public:
  NotingPresenter(std::unique_ptr<StimulusPresenter> presenter, std::shared_ptr<ShownNow> shown)
      : presenter_(std::move(presenter)), shown_(std::move(shown)) {}
  absl::Status Present(const CaptureSpec& spec) override {
    shown_->spec = spec;
    return presenter_->Present(spec);
  }

 private:
  const std::unique_ptr<StimulusPresenter> presenter_;
  const std::shared_ptr<ShownNow> shown_;
};

// Converts whenever the clock of the test has moved on by a sample period.
class RestlessPhotodiode final : public Photodiode {
 public:
  static constexpr double kZeroCounts = 40;
  static constexpr int32_t kRail = 4095;

  RestlessPhotodiode(const ManualClock& clock, std::shared_ptr<const ShownNow> shown, LightAt light,
                     double noise_counts)
      : clock_(clock),
        shown_(std::move(shown)),
        light_(std::move(light)),
        noise_counts_(noise_counts) {
    info_.uri = "test:restless";
    info_.significant_bits = 12;
    info_.maximum_counts = kRail;
    info_.sample_rate_min_hz = 1;
    info_.sample_rate_max_hz = 10000;
  }

  const PhotodiodeInfo& Info() const override { return info_; }
  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    period_ns_ = std::llround(1e9 / settings.sample_rate_hz);
    return settings;
  }
  absl::Status Start() override {
    next_ns_ = clock_.MonotonicNs();
    sequence_ = 0;
    return absl::OkStatus();
  }
  absl::Status Stop() override { return absl::OkStatus(); }

  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds) override {
    SampleBlock block{.sequence = sequence_};
    for (; next_ns_ <= clock_.MonotonicNs(); next_ns_ += period_ns_, ++sequence_) {
      block.samples.push_back({next_ns_, Convert()});
    }
    if (block.samples.empty()) return absl::DeadlineExceededError("no conversion is due");
    return block;
  }

 private:
  int32_t Convert() {
    const double lit = shown_->spec.kind == FrameKind::kLight ? light_(shown_->spec, next_ns_) : 0;
    double noise = -6;  // of 12 uniform numbers: near enough to a normal one
    for (int i = 0; i < 12; ++i) noise += static_cast<double>(random_.Below(1 << 30)) / (1 << 30);
    const double counts = kZeroCounts + lit + noise_counts_ * noise;
    return static_cast<int32_t>(std::lround(std::clamp(counts, 0.0, double{kRail})));
  }

  PhotodiodeInfo info_;
  const ManualClock& clock_;
  const std::shared_ptr<const ShownNow> shown_;
  const LightAt light_;
  const double noise_counts_;
  RandomStream random_{{77}};
  int64_t period_ns_ = 0;
  int64_t next_ns_ = 0;
  uint64_t sequence_ = 0;
};

// Puts one into `rig`, which runs by `clock`.
inline void AddPhotodiode(Rig& rig, const ManualClock& clock, LightAt light, double noise_counts) {
  auto shown = std::make_shared<ShownNow>();
  rig.presenter = std::make_unique<NotingPresenter>(std::move(rig.presenter), shown);
  rig.photodiode =
      std::make_unique<RestlessPhotodiode>(clock, std::move(shown), std::move(light), noise_counts);
}

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_SUPPORT_RESTLESS_PHOTODIODE_H_
