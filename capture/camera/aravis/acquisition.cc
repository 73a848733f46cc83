#include "capture/camera/aravis/acquisition.h"

#include <algorithm>
#include <string>
#include <utility>

#include "capture/base/status.h"
#include "capture/base/unpack.h"
#include "capture/camera/aravis/fake_scene.h"

namespace eyebox::capture::aravis {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr microseconds kSlice{20000};  // between two looks at the heartbeat
constexpr int64_t kTemperatureIntervalNs = 1000000000;
constexpr int64_t kPoolBytes = int64_t{256} << 20;

FrameIdWidth WidthOfIds(const Device& device) {
  if (device.is_fake()) return FrameIdWidth::k16Bit;
  if (!device.is_gige()) return FrameIdWidth::k64Bit;
  if (!device.Has("GevGVSPExtendedIDMode")) return FrameIdWidth::k16Bit;
  const auto mode = device.GetText("GevGVSPExtendedIDMode");
  return mode.ok() && *mode == "On" ? FrameIdWidth::k64Bit : FrameIdWidth::k16Bit;
}

int BufferCount(const AravisOptions& options, int64_t payload_bytes) {
  if (options.buffers > 0) return options.buffers;
  return static_cast<int>(std::clamp<int64_t>(kPoolBytes / payload_bytes, 8, 128));
}

absl::Status PushPacketOptions(Device& device, const AravisOptions& options) {
  if (!device.is_gige()) return absl::OkStatus();
  if (options.packet_size_bytes > 0) {
    EYEBOX_RETURN_IF_ERROR(device.SetPacketSize(options.packet_size_bytes));
  }
  return options.packet_delay_ns > 0 ? device.SetPacketDelay(options.packet_delay_ns)
                                     : absl::OkStatus();
}

std::string TextOr(const Device& device, const std::string& feature) {
  return device.Has(feature) ? device.GetText(feature).value_or("") : "";
}

}  // namespace

Acquisition::Acquisition(AravisOptions options, std::unique_ptr<Device> device, const Clock* clock)
    : options_(std::move(options)),
      device_(std::move(device)),
      clock_(clock),
      frame_ids_(WidthOfIds(*device_)),
      planes_(std::make_shared<CountPlanes>()) {}

absl::StatusOr<std::unique_ptr<Acquisition>> Acquisition::Open(const AravisOptions& options,
                                                               const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(std::unique_ptr<Device> device, Device::Open(options));
  if (device->is_fake()) ShowFakeScene(*device, options.fake_rate_hz);
  EYEBOX_RETURN_IF_ERROR(PushPacketOptions(*device, options));
  std::unique_ptr<Acquisition> opened(new Acquisition(options, std::move(device), clock));
  EYEBOX_RETURN_IF_ERROR(opened->Describe());
  return opened;
}

absl::Status Acquisition::Describe() {
  EYEBOX_ASSIGN_OR_RETURN(fixed_, ChooseFixedState(*device_, options_));
  info_.uri = options_.uri;
  info_.vendor = TextOr(*device_, "DeviceVendorName");
  info_.model = TextOr(*device_, "DeviceModelName");
  info_.serial = device_->Serial();
  info_.sensor_size = fixed_.region.size;
  info_.significant_bits = fixed_.pixel_format.significant_bits;
  info_.pixel_format = std::string(fixed_.pixel_format.name);
  EYEBOX_ASSIGN_OR_RETURN(const Limits<double> exposure_s, device_->ExposureLimitsS());
  info_.exposure_min_s = exposure_s.minimum;
  info_.exposure_max_s = exposure_s.maximum;
  EYEBOX_ASSIGN_OR_RETURN(const Limits<double> gain_db, GainLimitsDb(*device_));
  info_.gain_min_db = gain_db.minimum;
  info_.gain_max_db = gain_db.maximum;
  if (fixed_.black_level) {
    EYEBOX_ASSIGN_OR_RETURN(const Limits<double> black_level, device_->BlackLevelLimits());
    info_.black_level_min = black_level.minimum;
    info_.black_level_max = black_level.maximum;
  }
  EYEBOX_ASSIGN_OR_RETURN(TriggerSources triggers, FindTriggerSources(*device_));
  info_.software_trigger = triggers.software;
  info_.trigger_lines = std::move(triggers.lines);
  info_.free_run = true;
  return absl::OkStatus();
}

absl::Status Acquisition::CheckPresent() const {
  if (!device_->lost()) return absl::OkStatus();
  return DeviceFailed(options_.uri, "is gone", "check cable and power, then open the rig again");
}

// What failed because the camera is gone says so.
absl::Status Acquisition::Blame(const absl::Status& failure) const {
  const absl::Status present = CheckPresent();
  return present.ok() ? failure : present;
}

absl::StatusOr<CameraSettings> Acquisition::Configure(const CameraSettings& settings) {
  EYEBOX_RETURN_IF_ERROR(CheckPresent());
  absl::StatusOr<CameraSettings> set = PushKnownState(*device_, fixed_, settings);
  if (!set.ok()) return Blame(set.status());
  settings_ = settings;
  return set;
}

absl::Status Acquisition::Start() {
  EYEBOX_RETURN_IF_ERROR(CheckPresent());
  if (!pool_) {
    const absl::StatusOr<int64_t> payload_bytes = device_->GetInteger("PayloadSize");
    if (!payload_bytes.ok()) return Blame(payload_bytes.status());
    pool_ =
        MakeBufferPool(BufferCount(options_, *payload_bytes), static_cast<size_t>(*payload_bytes));
  }
  absl::StatusOr<std::unique_ptr<Stream>> stream = Stream::Open(*device_, options_, pool_, clock_);
  if (!stream.ok()) return Blame(stream.status());
  stream_ = *std::move(stream);
  trigger_times_ns_.clear();
  previous_frame_id_.reset();
  frame_ids_.Restart();
  ReadTemperature();
  // The in-process fake camera knows no trigger: it fills a buffer as soon as it has one, so that
  // handing it one is the trigger.
  if (!device_->is_fake() || settings_.trigger == TriggerSource::kFreeRun) stream_->OfferAll();
  const absl::Status started = Blame(device_->Execute("AcquisitionStart"));
  if (!started.ok()) stream_.reset();
  return started;
}

absl::Status Acquisition::Trigger() {
  EYEBOX_RETURN_IF_ERROR(CheckPresent());
  if (settings_.trigger != TriggerSource::kSoftware) {
    return Rejected(options_.uri, "is not triggered by software",
                    "pulse its line, or configure a software trigger");
  }
  const bool fake = device_->is_fake();
  // What arrives unasked belongs to a trigger from before.
  if (!fake && trigger_times_ns_.empty()) {
    while (stream_->Pop(microseconds{0})) {
    }
  }
  if (!fake) stream_->OfferAll();
  const int64_t now_ns = clock_->MonotonicNs();
  if (fake ? stream_->OfferOne() == 0 : stream_->Waiting() == 0) {
    return Rejected(options_.uri, "has no buffer for another frame",
                    "let go of frames, or open it with more ?buffers=N");
  }
  if (!fake) EYEBOX_RETURN_IF_ERROR(Blame(device_->Execute("TriggerSoftware")));
  trigger_times_ns_.push_back(now_ns);
  return absl::OkStatus();
}

absl::StatusOr<Frame> Acquisition::NextFrame(milliseconds timeout) {
  if (settings_.trigger == TriggerSource::kSoftware && trigger_times_ns_.empty()) {
    return absl::DeadlineExceededError(
        Complaint(options_.uri, "has no frame to deliver", "trigger it once for every frame"));
  }
  EYEBOX_ASSIGN_OR_RETURN(Arrival arrival, WaitForArrival(timeout));
  Frame frame = FrameOf(std::move(arrival));
  if (clock_->MonotonicNs() - temperature_read_ns_ >= kTemperatureIntervalNs) ReadTemperature();
  return frame;
}

absl::StatusOr<Arrival> Acquisition::WaitForArrival(milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (true) {
    EYEBOX_RETURN_IF_ERROR(CheckPresent());
    if (!device_->is_fake() || settings_.trigger == TriggerSource::kFreeRun) stream_->OfferAll();
    const auto left = std::chrono::ceil<microseconds>(deadline - std::chrono::steady_clock::now());
    std::optional<Arrival> arrival = stream_->Pop(std::clamp(left, microseconds{0}, kSlice));
    if (arrival) return *std::move(arrival);
    if (left <= microseconds{0}) break;
  }
  // Silence: is the camera still there? Its heartbeat would tell only seconds later.
  device_->Answers();
  EYEBOX_RETURN_IF_ERROR(CheckPresent());
  return absl::DeadlineExceededError(Complaint(
      options_.uri, "delivered no frame within " + std::to_string(timeout.count()) + " ms",
      "check its trigger and the packet options"));
}

Frame Acquisition::FrameOf(Arrival arrival) {
  Frame frame;
  FrameMetadata& metadata = frame.metadata;
  metadata.status = arrival.status;
  metadata.camera_frame_id = frame_ids_.Unwrap(arrival.device_id);
  metadata.missing_packets = arrival.missing_packets;
  metadata.device_time_ns = arrival.device_time_ns;
  metadata.monotonic_time_ns = arrival.monotonic_time_ns;
  metadata.trigger_time_ns = TakeTriggerTime(metadata.camera_frame_id);
  metadata.exposure_asked_s = settings_.exposure_s;
  metadata.gain_asked_db = settings_.gain_db;
  metadata.temperature_degC = temperature_degC_;
  frame.view.size = info_.sensor_size;
  if (metadata.status != BufferStatus::kComplete) return frame;
  if (arrival.pfnc != fixed_.pixel_format.pfnc || arrival.size != info_.sensor_size) {
    metadata.status = BufferStatus::kDeviceError;
    return frame;
  }
  const size_t pixels = info_.sensor_size.PixelCount();
  const size_t bytes = pixels * sizeof(uint16_t);
  const PixelPacking packing = fixed_.pixel_format.packing;
  if (packing == PixelPacking::kWords && arrival.padding_bytes == 0 &&
      arrival.bytes.size() >= bytes) {
    frame.view.pixels_dn = {reinterpret_cast<const uint16_t*>(arrival.bytes.data()), pixels};
    frame.owner = std::move(arrival.owner);
    return frame;
  }
  const size_t row_bytes = PackedBytes(packing, static_cast<size_t>(info_.sensor_size.width_px));
  const size_t stride = arrival.padding_bytes > 0 ? row_bytes + arrival.padding_bytes : 0;
  auto counts_dn = planes_->Take(pixels);
  if (!Unpack(packing, arrival.bytes, info_.sensor_size, stride, *counts_dn).ok()) {
    metadata.status = BufferStatus::kDeviceError;  // fewer bytes than the format has
    return frame;
  }
  frame.view.pixels_dn = *counts_dn;
  frame.owner = std::move(counts_dn);
  return frame;
}

// A frame that was dropped takes its trigger with it.
std::optional<int64_t> Acquisition::TakeTriggerTime(uint64_t frame_id) {
  const uint64_t step = previous_frame_id_ ? frame_id - *previous_frame_id_ : 1;
  if (step == 0 || step > UINT64_MAX / 2) return std::nullopt;  // came late or twice
  previous_frame_id_ = frame_id;
  if (step > trigger_times_ns_.size()) {
    trigger_times_ns_.clear();
    return std::nullopt;
  }
  const int64_t time_ns = trigger_times_ns_[step - 1];
  trigger_times_ns_.erase(trigger_times_ns_.begin(),
                          trigger_times_ns_.begin() + static_cast<std::ptrdiff_t>(step));
  return time_ns;
}

void Acquisition::ReadTemperature() {
  temperature_read_ns_ = clock_->MonotonicNs();
  if (!device_->Has("DeviceTemperature")) return;
  const absl::StatusOr<double> temperature = device_->GetFloat("DeviceTemperature");
  temperature_degC_ = temperature.ok() ? std::optional(*temperature) : std::nullopt;
}

absl::Status Acquisition::Stop() {
  if (!stream_) return absl::OkStatus();
  const absl::Status stopped =
      device_->lost() ? absl::OkStatus() : Blame(device_->Execute("AcquisitionStop"));
  stream_.reset();
  trigger_times_ns_.clear();
  return stopped;
}

}  // namespace eyebox::capture::aravis
