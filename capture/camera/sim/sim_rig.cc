#include "capture/camera/sim/sim_rig.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/camera/camera_state.h"
#include "capture/camera/sim/faults.h"
#include "capture/camera/sim/scene.h"
#include "capture/camera/sim/sensor.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kScheme = "sim:";
constexpr uint64_t kFrameStream = 100;  // keys apart from those of the fixed pattern
constexpr uint64_t kFlashStream = 101;
constexpr int64_t kReadoutNs = 1000000;  // between the end of an exposure and the next one

// What camera and presenter share: the sensor looking at the headset.
class SimBench {
 public:
  SimBench(const SimParameters& parameters, uint64_t seed)
      : parameters_(parameters),
        seed_(seed),
        pattern_(MakeFixedPattern(parameters.sensor, seed)),
        rate_e_s_(parameters.sensor.size, 0.0),
        exposure_fault_(parameters.faults, parameters.sensor) {}

  absl::Status Present(const CaptureSpec& spec) {
    if (!IsShown(spec)) {
      EYEBOX_ASSIGN_OR_RETURN(rate_e_s_, SceneRate(parameters_, pattern_, spec));
      shown_ = spec;
    }
    ++presentation_;
    exposure_ = 0;
    return absl::OkStatus();
  }

  std::vector<uint16_t> Expose(CameraSettings settings) {
    settings.exposure_s = exposure_fault_.Made(settings, rate_e_s_);
    NoiseSource noise({seed_, kFrameStream, presentation_, exposure_});
    Image<double> rate_e_s = Rate(settings.exposure_s);
    AddWarmth(rate_e_s);
    auto counts_dn = capture::Expose(parameters_.sensor, pattern_, rate_e_s, settings, noise);
    ++exposure_;
    Distort(parameters_.faults, parameters_.sensor, counts_dn);
    return counts_dn;
  }

  std::optional<double> TemperatureDegC() const {
    return SensorTemperatureDegC(parameters_.faults, presentation_);
  }

 private:
  // Camera and display run on clocks of their own: an exposure begins anywhere in a period.
  Image<double> Rate(double exposure_s) const {
    const SimFaults& faults = parameters_.faults;
    const bool flashes = faults.strobe_period_s > 0 && shown_ && shown_->kind == FrameKind::kLight;
    if (!flashes) return rate_e_s_;
    NoiseSource when({seed_, kFlashStream, presentation_, exposure_});
    return Flashed(faults, rate_e_s_, when.Uniform() * faults.strobe_period_s, exposure_s);
  }

  // Dark current beyond that of the cold sensor.
  void AddWarmth(Image<double>& rate_e_s) const {
    const double growth = DarkCurrentGrowth(TemperatureDegC());
    if (growth == 1) return;
    for (size_t i = 0; i < rate_e_s.pixels().size(); ++i) {
      rate_e_s.pixels()[i] += (growth - 1) * pattern_.dark_current_e_s.pixels()[i];
    }
  }

  // The scene does not depend on exposure, gain or name, so that a bracket draws it once.
  bool IsShown(const CaptureSpec& spec) const {
    return shown_ && shown_->kind == spec.kind && shown_->stimulus == spec.stimulus &&
           shown_->luminance_cd_m2 == spec.luminance_cd_m2;
  }

  const SimParameters parameters_;
  const uint64_t seed_;
  const FixedPattern pattern_;
  Image<double> rate_e_s_;
  ExposureFault exposure_fault_;
  std::optional<CaptureSpec> shown_;
  uint64_t presentation_ = 0;
  uint64_t exposure_ = 0;
};

CameraInfo InfoOf(const RigConfig& config, const SimParameters& parameters) {
  const SensorParameters& sensor = parameters.sensor;
  return {.uri = config.camera_uri,
          .vendor = "Eyebox",
          .model = "simulator",
          .serial = parameters.name,
          .sensor_size = sensor.size,
          .significant_bits = sensor.bits,
          .exposure_min_s = sensor.exposure_min_s,
          .exposure_max_s = sensor.exposure_max_s,
          .gain_min_db = 0,
          .gain_max_db = sensor.gain_max_db,
          .geometry = parameters.geometry};
}

class SimCamera final : public Camera {
 public:
  SimCamera(CameraInfo info, const SimParameters& parameters, std::shared_ptr<SimBench> bench,
            const Clock* clock)
      : info_(std::move(info)),
        state_(info_.uri),
        bias_dn_(parameters.faults.black_clamped ? 0 : parameters.sensor.bias_dn),
        least_gain_db_(parameters.faults.stuck_gain_db),
        bench_(std::move(bench)),
        clock_(clock) {}

  const CameraInfo& Info() const override { return info_; }

  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.Configure(info_, settings));
    return Settings();
  }

  absl::Status Start() override { return state_.Start(); }

  // The exposure begins and ends here: what is presented later does not change its light.
  absl::Status Trigger() override {
    EYEBOX_RETURN_IF_ERROR(state_.Trigger());
    pending_.push_back(TakeFrame());
    return absl::OkStatus();
  }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds) override {
    EYEBOX_RETURN_IF_ERROR(state_.TakePending());
    Frame frame = std::move(pending_.front());
    pending_.pop_front();
    return frame;
  }

  absl::Status Stop() override {
    state_.Stop();
    pending_.clear();
    return absl::OkStatus();
  }

 private:
  // As the camera has them, which its faults may have changed.
  CameraSettings Settings() const {
    CameraSettings settings = state_.settings();
    settings.gain_db = std::max(settings.gain_db, least_gain_db_);
    return settings;
  }

  Frame TakeFrame() {
    auto counts_dn = std::make_shared<const std::vector<uint16_t>>(bench_->Expose(Settings()));
    Frame frame;
    frame.metadata = NextMetadata();
    frame.view = {.pixels_dn = *counts_dn, .size = info_.sensor_size};
    frame.owner = std::move(counts_dn);
    return frame;
  }

  FrameMetadata NextMetadata() {
    const CameraSettings& settings = state_.settings();
    device_time_ns_ += kReadoutNs + static_cast<int64_t>(settings.exposure_s * 1e9);
    FrameMetadata metadata;
    metadata.camera_frame_id = ++frame_id_;
    metadata.device_time_ns = device_time_ns_;
    metadata.monotonic_time_ns = clock_->MonotonicNs();
    metadata.trigger_time_ns = metadata.monotonic_time_ns;
    metadata.exposure_asked_s = settings.exposure_s;
    metadata.exposure_reported_s = settings.exposure_s;
    metadata.gain_asked_db = settings.gain_db;
    metadata.gain_reported_db = Settings().gain_db;
    metadata.black_level_dn = bias_dn_;
    metadata.temperature_degC = bench_->TemperatureDegC();
    return metadata;
  }

  const CameraInfo info_;
  CameraState state_;
  const double bias_dn_;
  const double least_gain_db_;
  const std::shared_ptr<SimBench> bench_;
  const Clock* const clock_;
  std::deque<Frame> pending_;
  uint64_t frame_id_ = 0;
  int64_t device_time_ns_ = 0;
};

class SimPresenter final : public StimulusPresenter {
 public:
  explicit SimPresenter(std::shared_ptr<SimBench> bench) : bench_(std::move(bench)) {}
  absl::Status Present(const CaptureSpec& spec) override { return bench_->Present(spec); }

 private:
  const std::shared_ptr<SimBench> bench_;
};

}  // namespace

absl::StatusOr<SimParameters> SimParametersOf(const RigConfig& config) {
  if (!config.camera_uri.starts_with(kScheme)) {
    return BadInput(config.camera_uri, "is not a simulated rig", "give a URI like sim:rift-s-like");
  }
  const std::string_view name = std::string_view(config.camera_uri).substr(kScheme.size());
  const size_t query = name.find('?');
  EYEBOX_ASSIGN_OR_RETURN(SimParameters parameters, NamedSimParameters(name.substr(0, query)));
  if (query == std::string_view::npos) return parameters;
  EYEBOX_ASSIGN_OR_RETURN(parameters.faults, ParseFaults(name.substr(query + 1)));
  parameters.name = name;
  return parameters;
}

absl::StatusOr<Rig> OpenSimRig(const RigConfig& config, const SimParameters& parameters,
                               const Clock* clock) {
  EYEBOX_RETURN_IF_ERROR(parameters.Validate());
  auto bench = std::make_shared<SimBench>(parameters, config.seed);
  Rig rig;
  rig.config = config;
  rig.origin = RecordingOrigin::kSimulated;
  rig.camera = std::make_unique<SimCamera>(InfoOf(config, parameters), parameters, bench, clock);
  rig.presenter = std::make_unique<SimPresenter>(std::move(bench));
  return rig;
}

}  // namespace eyebox::capture
