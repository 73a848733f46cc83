#include "capture/photodiode/iio/iio_photodiode.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <deque>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/photodiode/photodiode_state.h"

namespace eyebox::capture {
namespace {

constexpr char kClockAttribute[] = "current_timestamp_clock";
constexpr char kRateAttribute[] = "sampling_frequency";
constexpr double kBlockSeconds = 0.01;
constexpr size_t kMaxBlockSamples = 4096;
constexpr size_t kKernelSamples = 16384;
constexpr double kRateTolerance = 0.01;

std::string Trimmed(std::string text) {
  text.erase(text.find_last_not_of(" \n\t") + 1);
  return text;
}

class IioPhotodiode final : public Photodiode {
 public:
  IioPhotodiode(std::string uri, std::unique_ptr<iio::IioDevice> device, const Clock* clock)
      : state_(uri), device_(std::move(device)), clock_(clock) {
    const iio::ChannelFormat format = device_->Format();
    info_.uri = std::move(uri);
    info_.model = device_->Name();
    info_.significant_bits = format.bits;
    const int64_t levels = int64_t{1} << std::min(format.bits, 32);
    info_.minimum_counts = static_cast<int32_t>(format.is_signed ? -levels / 2 : 0);
    info_.maximum_counts = static_cast<int32_t>((format.is_signed ? levels / 2 : levels) - 1);
    info_.sample_rate_min_hz = 1;
    info_.sample_rate_max_hz = 1e6;
    info_.can_be_pulse_started = true;
  }

  absl::Status UseMonotonicTime() {
    EYEBOX_RETURN_IF_ERROR(device_->WriteAttribute(kClockAttribute, "monotonic"));
    EYEBOX_ASSIGN_OR_RETURN(const std::string set, device_->ReadAttribute(kClockAttribute));
    if (Trimmed(set) == "monotonic") return absl::OkStatus();
    return DeviceFailed(info_.uri, "stamps with the clock '" + Trimmed(set) + "'",
                        "its driver must support current_timestamp_clock");
  }

  const PhotodiodeInfo& Info() const override { return info_; }

  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckConfigure(info_, settings));
    PhotodiodeSettings read_back = settings;
    if (!settings.pulse_started) {
      EYEBOX_ASSIGN_OR_RETURN(read_back.sample_rate_hz, SetRate(settings.sample_rate_hz));
    }
    state_.Configured(read_back);
    return read_back;
  }

  absl::Status Start() override {
    EYEBOX_RETURN_IF_ERROR(state_.Start(clock_->MonotonicNs()));
    const double block = state_.settings().sample_rate_hz * kBlockSeconds;
    const size_t samples =
        state_.settings().pulse_started
            ? 1
            : static_cast<size_t>(std::clamp(block, 1.0, static_cast<double>(kMaxBlockSamples)));
    waiting_.clear();
    last_ns_ = 0;
    next_sequence_ = 0;
    const absl::Status opened = device_->OpenBuffer(samples, kKernelSamples);
    if (!opened.ok()) state_.Stop();
    return opened;
  }

  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds timeout) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckRead());
    if (waiting_.empty()) {
      EYEBOX_ASSIGN_OR_RETURN(const auto raw, device_->Refill(timeout));
      if (raw.empty()) return state_.Silence(clock_->MonotonicNs());
      state_.Heard(clock_->MonotonicNs());
      for (const iio::RawSample& sample : raw) EYEBOX_RETURN_IF_ERROR(Add(sample));
    }
    SampleBlock block = std::move(waiting_.front());
    waiting_.pop_front();
    return block;
  }

  absl::Status Stop() override {
    if (state_.running()) device_->CloseBuffer();
    state_.Stop();
    return absl::OkStatus();
  }

 private:
  // The trigger's rate or, where the converter times itself, its own.
  absl::StatusOr<double> SetRate(double rate_hz) {
    const std::string text = std::to_string(rate_hz);
    absl::Status written = device_->WriteTriggerAttribute(kRateAttribute, text);
    const bool of_trigger = !absl::IsNotFound(written);
    if (!of_trigger && device_->TimesItself()) {
      written = device_->WriteAttribute(kRateAttribute, text);
    }
    if (absl::IsNotFound(written)) {
      return BadInput(info_.uri + " sample_rate_hz", "cannot be set with this trigger",
                      "use an hrtimer trigger, or let pulses start the conversions");
    }
    EYEBOX_RETURN_IF_ERROR(written);
    EYEBOX_ASSIGN_OR_RETURN(const std::string set,
                            of_trigger ? device_->ReadTriggerAttribute(kRateAttribute)
                                       : device_->ReadAttribute(kRateAttribute));
    double set_hz = 0;
    std::from_chars(set.data(), set.data() + set.size(), set_hz);
    if (std::abs(set_hz - rate_hz) <= kRateTolerance * rate_hz) return set_hz;
    return DeviceFailed(info_.uri, "was asked for " + text + " Hz and reads back " + Trimmed(set),
                        "ask for a rate that it can hold");
  }

  absl::Status Add(const iio::RawSample& raw) {
    if (raw.timestamp_ns <= last_ns_) {
      return DeviceFailed(info_.uri, "gave time stamps that do not ascend",
                          "its driver does not stamp conversions; use another converter");
    }
    // A stamp of the wall clock would be decades ahead of a monotonic one.
    if (raw.timestamp_ns > clock_->MonotonicNs()) {
      return DeviceFailed(info_.uri, "stamps conversions with a clock that is not CLOCK_MONOTONIC",
                          "its driver must support current_timestamp_clock");
    }
    const uint64_t lost = LostBefore(raw.timestamp_ns);
    if (waiting_.empty() || lost > 0) {
      waiting_.push_back({.sequence = next_sequence_ + lost, .lost_before = lost});
    }
    SampleBlock& block = waiting_.back();
    block.samples.push_back(
        {.monotonic_ns = raw.timestamp_ns, .counts = static_cast<int32_t>(raw.value)});
    next_sequence_ = block.sequence + block.samples.size();
    last_ns_ = raw.timestamp_ns;
    return absl::OkStatus();
  }

  uint64_t LostBefore(int64_t timestamp_ns) const {
    if (last_ns_ == 0 || state_.settings().pulse_started) return 0;
    const double periods =
        static_cast<double>(timestamp_ns - last_ns_) * 1e-9 * state_.settings().sample_rate_hz;
    return periods < 1.5 ? 0 : static_cast<uint64_t>(std::llround(periods)) - 1;
  }

  PhotodiodeInfo info_;
  PhotodiodeState state_;
  const std::unique_ptr<iio::IioDevice> device_;
  const Clock* const clock_;
  std::deque<SampleBlock> waiting_;
  int64_t last_ns_ = 0;
  uint64_t next_sequence_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Photodiode>> MakeIioPhotodiode(
    std::string uri, std::unique_ptr<iio::IioDevice> device, const Clock* clock) {
  if (device->Format().bits < 1 || device->Format().bits > 32) {
    return DeviceFailed(uri, "has samples of " + std::to_string(device->Format().bits) + " bits",
                        "use a converter of 1 to 32 bits");
  }
  auto photodiode = std::make_unique<IioPhotodiode>(std::move(uri), std::move(device), clock);
  EYEBOX_RETURN_IF_ERROR(photodiode->UseMonotonicTime());
  return photodiode;
}

absl::StatusOr<std::unique_ptr<Photodiode>> OpenIioPhotodiode(const PhotodiodeConfig& config,
                                                              const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const iio::DeviceAddress address, iio::ParseIioUri(config.uri));
  EYEBOX_ASSIGN_OR_RETURN(auto device, iio::OpenLibiioDevice(address));
  return MakeIioPhotodiode(config.uri, std::move(device), clock);
}

}  // namespace eyebox::capture
