#include "capture/camera/v4l2/v4l2_camera.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "capture/base/status.h"
#include "capture/base/unpack.h"
#include "capture/camera/camera_state.h"
#include "capture/camera/manual_presenter.h"
#include "capture/camera/v4l2/frame_gate.h"
#include "capture/camera/v4l2/v4l2_uri.h"
#include "capture/camera/v4l2/video_controls.h"
#include "capture/camera/v4l2/video_format.h"
#include "capture/camera/v4l2/video_node.h"
#include "capture/camera/v4l2/video_stream.h"

namespace eyebox::capture {
namespace {

constexpr int kRingBuffers = 4;
constexpr double kExposureUnitS = 1e-4;  // of V4L2_CID_EXPOSURE_ABSOLUTE

int64_t ToNs(double seconds) { return std::llround(seconds * 1e9); }

// What was found out about the device when it was opened.
struct Device {
  V4l2Options options;
  std::unique_ptr<VideoNode> node;
  VideoFormat format;
  FrameIntervals intervals;
  Control exposure;
  std::optional<Control> gain;
  std::optional<Control> black_level;
};

// The name that GenICam gives to such counts; how V4L2 packs them does not show in a frame.
std::string PixelFormatName(const V4l2Format& pixel) {
  switch (pixel.mosaic) {
    case BayerMosaic::kNone:
      break;
    case BayerMosaic::kGrbg:
      return "BayerGR" + std::to_string(pixel.significant_bits);
    case BayerMosaic::kRggb:
      return "BayerRG" + std::to_string(pixel.significant_bits);
    case BayerMosaic::kGbrg:
      return "BayerGB" + std::to_string(pixel.significant_bits);
    case BayerMosaic::kBggr:
      return "BayerBG" + std::to_string(pixel.significant_bits);
  }
  return "Mono" + std::to_string(pixel.significant_bits);
}

absl::StatusOr<Device> Examine(std::string_view uri, VideoSyscalls* syscalls) {
  Device device;
  EYEBOX_ASSIGN_OR_RETURN(device.options, ParseV4l2Uri(uri));
  EYEBOX_ASSIGN_OR_RETURN(device.node, VideoNode::Open(device.options.path, syscalls));
  const VideoNode& node = *device.node;
  EYEBOX_ASSIGN_OR_RETURN(device.format, SetVideoFormat(node, device.options));
  EYEBOX_ASSIGN_OR_RETURN(device.intervals, OfferedIntervals(node, device.format));
  EYEBOX_ASSIGN_OR_RETURN(device.exposure, FindExposureControl(node));
  EYEBOX_ASSIGN_OR_RETURN(device.gain, FindGainControl(node));
  EYEBOX_ASSIGN_OR_RETURN(device.black_level, FindBlackLevelControl(node));
  return device;
}

CameraInfo InfoOf(const Device& device) {
  CameraInfo info;
  info.uri = device.options.uri;
  info.model = device.node->card();
  info.sensor_size = device.format.size;
  info.significant_bits = device.format.pixel.significant_bits;
  info.exposure_min_s = std::max(device.exposure.minimum, 1) * kExposureUnitS;
  info.exposure_max_s =
      std::min(device.exposure.maximum * kExposureUnitS, device.intervals.LongestS());
  if (device.gain && device.options.gain_db_per_step) {
    info.gain_max_db = (static_cast<double>(device.gain->maximum) - device.gain->minimum) *
                       *device.options.gain_db_per_step;
  }
  info.pixel_format = PixelFormatName(device.format.pixel);
  if (device.black_level) {
    info.black_level_min = device.black_level->minimum;
    info.black_level_max = device.black_level->maximum;
  }
  return info;
}

class V4l2Camera final : public Camera {
 public:
  V4l2Camera(Device device, const Clock* clock)
      : device_(std::move(device)), info_(InfoOf(device_)), clock_(clock), state_(info_.uri) {}

  const CameraInfo& Info() const override { return info_; }

  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.Configure(info_, settings));
    absl::StatusOr<CameraSettings> set = Push(settings);
    if (!set.ok()) state_ = CameraState(info_.uri);  // half a state is none
    return set;
  }

  absl::Status Start() override {
    EYEBOX_RETURN_IF_ERROR(state_.Start());
    WatchControls(*device_.node, held_);
    absl::StatusOr<std::unique_ptr<VideoStream>> stream =
        VideoStream::Start(*device_.node, kRingBuffers);
    if (!stream.ok()) {
      state_.Stop();
      return stream.status();
    }
    stream_ = *std::move(stream);
    gate_.emplace(clock_->MonotonicNs() + ToNs(interval_s_));
    return absl::OkStatus();
  }

  absl::Status Trigger() override {
    EYEBOX_RETURN_IF_ERROR(state_.Trigger());
    gate_->Trigger(clock_->MonotonicNs());
    return absl::OkStatus();
  }

  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) override {
    EYEBOX_RETURN_IF_ERROR(state_.TakePending());
    absl::StatusOr<std::optional<Frame>> frame = WaitForAnswer(timeout);
    if (frame.ok() && *frame) return **std::move(frame);
    gate_->Abandon();
    if (!frame.ok()) return frame.status();
    return absl::DeadlineExceededError(
        Complaint(info_.uri, "delivered no frame within " + std::to_string(timeout.count()) + " ms",
                  "check its cable and the bandwidth of its bus, or wait longer"));
  }

  absl::Status Stop() override {
    stream_.reset();
    gate_.reset();
    state_.Stop();
    return absl::OkStatus();
  }

 private:
  absl::StatusOr<CameraSettings> Push(const CameraSettings& settings) {
    const VideoNode& node = *device_.node;
    EYEBOX_ASSIGN_OR_RETURN(held_, MakeManual(node, device_.options));
    EYEBOX_ASSIGN_OR_RETURN(interval_s_,
                            SetFrameInterval(node, device_.intervals, settings.exposure_s));
    CameraSettings set = settings;
    const auto units = static_cast<int32_t>(std::lround(settings.exposure_s / kExposureUnitS));
    EYEBOX_ASSIGN_OR_RETURN(const int32_t exposure, Hold(device_.exposure, units));
    set.exposure_s = exposure * kExposureUnitS;
    if (device_.gain) {
      const Control& gain = *device_.gain;
      const double step_db = device_.options.gain_db_per_step.value_or(1);  // 1: only 0 dB passes
      const auto steps = static_cast<int32_t>(std::lround(settings.gain_db / step_db));
      EYEBOX_ASSIGN_OR_RETURN(const int32_t value, Hold(gain, gain.minimum + steps));
      set.gain_db = (value - gain.minimum) * step_db;
    }
    if (settings.black_level && !device_.black_level) {
      return BadInput(info_.uri + " black_level", "is given", "this camera has no such control");
    }
    if (settings.black_level) {
      const auto value = static_cast<int32_t>(std::lround(*settings.black_level));
      EYEBOX_ASSIGN_OR_RETURN(set.black_level, Hold(*device_.black_level, value));
    }
    return set;
  }

  // Writes and reads back; what reads back is what must stay.
  absl::StatusOr<int32_t> Hold(const Control& control, int32_t value) {
    EYEBOX_ASSIGN_OR_RETURN(const int32_t reads, WriteControl(*device_.node, control, value));
    std::erase_if(held_, [&](const HeldControl& one) { return one.control.id == control.id; });
    held_.push_back({.control = control, .value = reads});
    return reads;
  }

  // Empty: none came in time.
  absl::StatusOr<std::optional<Frame>> WaitForAnswer(std::chrono::milliseconds timeout) {
    const int64_t deadline_ns = clock_->MonotonicNs() + timeout.count() * 1000000;
    while (true) {
      EYEBOX_ASSIGN_OR_RETURN(const std::optional<VideoBuffer> buffer, stream_->Dequeue());
      if (buffer) {
        EYEBOX_ASSIGN_OR_RETURN(std::optional<Frame> frame, Take(*buffer));
        if (frame) return frame;
      }
      const int64_t left_ns = deadline_ns - clock_->MonotonicNs();
      if (left_ns <= 0) return std::nullopt;
      if (!buffer) {
        EYEBOX_RETURN_IF_ERROR(
            stream_->Wait(std::chrono::milliseconds((left_ns + 999999) / 1000000)).status());
      }
    }
  }

  // The frame if it answers a trigger; the buffer goes back to the driver in any case.
  absl::StatusOr<std::optional<Frame>> Take(const VideoBuffer& buffer) {
    const std::optional<AdmittedFrame> admitted = gate_->Admit(buffer.sequence, StartNs(buffer));
    absl::StatusOr<std::optional<Frame>> frame = std::optional<Frame>();
    if (admitted) {
      frame = ToFrame(buffer, *admitted);
      if (frame.ok()) EYEBOX_RETURN_IF_ERROR(CheckWatched(*device_.node, held_));
    }
    EYEBOX_RETURN_IF_ERROR(stream_->Requeue(buffer.index));
    return frame;
  }

  // When the exposure began, at the earliest: a readout takes no longer than a frame interval.
  int64_t StartNs(const VideoBuffer& buffer) const {
    if (buffer.error && buffer.time_ns == 0) return clock_->MonotonicNs();
    if (buffer.time_is_start) return buffer.time_ns;
    return buffer.time_ns - ToNs(interval_s_ + state_.settings().exposure_s);
  }

  absl::StatusOr<std::optional<Frame>> ToFrame(const VideoBuffer& buffer,
                                               const AdmittedFrame& admitted) const {
    const VideoFormat& format = device_.format;
    Frame frame;
    frame.metadata = MetadataOf(buffer, admitted);
    frame.view.size = format.size;
    if (buffer.error || buffer.bytes.size() < format.image_bytes) {
      frame.metadata.status = BufferStatus::kDeviceError;
      return frame;
    }
    const size_t pixels = format.size.PixelCount();
    auto counts_dn = std::make_shared_for_overwrite<uint16_t[]>(pixels);
    const std::span<uint16_t> view(counts_dn.get(), pixels);
    EYEBOX_RETURN_IF_ERROR(
        Unpack(format.pixel.packing, buffer.bytes, format.size, format.stride_bytes, view));
    EYEBOX_RETURN_IF_ERROR(CheckDepth(view));
    frame.view.pixels_dn = view;
    frame.owner = std::move(counts_dn);
    return frame;
  }

  FrameMetadata MetadataOf(const VideoBuffer& buffer, const AdmittedFrame& admitted) const {
    FrameMetadata metadata;
    metadata.camera_frame_id = admitted.frame_id;
    metadata.device_time_ns = buffer.time_ns;
    metadata.monotonic_time_ns = clock_->MonotonicNs();
    metadata.trigger_time_ns = admitted.trigger_time_ns;
    metadata.exposure_asked_s = state_.settings().exposure_s;
    metadata.gain_asked_db = state_.settings().gain_db;
    return metadata;
  }

  absl::Status CheckDepth(std::span<const uint16_t> counts_dn) const {
    uint16_t seen = 0;
    for (const uint16_t count_dn : counts_dn) seen |= count_dn;
    if (seen >> info_.significant_bits == 0) return absl::OkStatus();
    const V4l2Format& pixel = device_.format.pixel;
    return DeviceFailed(info_.uri,
                        "delivers counts above " +
                            std::to_string((1 << info_.significant_bits) - 1) + " in " +
                            std::string(pixel.name) + ": they are shifted up, or of another format",
                        "choose another with format=... in the URI");
  }

  Device device_;
  const CameraInfo info_;
  const Clock* const clock_;
  CameraState state_;
  std::vector<HeldControl> held_;
  double interval_s_ = 0;
  std::unique_ptr<VideoStream> stream_;
  std::optional<FrameGate> gate_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Camera>> OpenV4l2Camera(std::string_view uri, const Clock* clock,
                                                       VideoSyscalls* syscalls) {
  EYEBOX_ASSIGN_OR_RETURN(Device device, Examine(uri, syscalls));
  return std::make_unique<V4l2Camera>(std::move(device), clock);
}

absl::StatusOr<Rig> OpenV4l2Rig(const RigConfig& config, const Clock* clock) {
  Rig rig;
  rig.config = config;
  EYEBOX_ASSIGN_OR_RETURN(rig.camera, OpenV4l2Camera(config.camera_uri, clock));
  rig.presenter = std::make_unique<ManualPresenter>();
  return rig;
}

}  // namespace eyebox::capture
