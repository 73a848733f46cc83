#include "capture/photodiode/serial/serial_photodiode.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "capture/base/status.h"
#include "capture/photodiode/photodiode_state.h"
#include "capture/photodiode/serial/clock_map.h"
#include "capture/photodiode/serial/link.h"

namespace eyebox::capture {
namespace {

using serial::Arrival;
using serial::Link;
using serial::Request;
using serial::RequestType;
using serial::Samples;
using serial::State;
using Milliseconds = std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr std::string_view kScheme = "serial:";
constexpr auto kAnswerTimeout = Milliseconds(250);
constexpr int kAnswerAttempts = 8;
constexpr int kBootAttempts = 20;  // an UNO that was reset by the opening answers after 2 s
constexpr int kRoundTripsAtStart = 8;
constexpr int64_t kRoundTripIntervalNs = 250'000'000;

Milliseconds Until(SteadyClock::time_point deadline) {
  const auto left = std::chrono::ceil<Milliseconds>(deadline - SteadyClock::now());
  return std::max(left, Milliseconds(0));
}

class SerialPhotodiode final : public Photodiode {
 public:
  SerialPhotodiode(std::string uri, std::unique_ptr<Link> link, const Clock* clock)
      : state_(uri), link_(std::move(link)), clock_(clock) {
    info_.uri = std::move(uri);
  }

  // Waits for the board and learns what it can do.
  absl::Status Meet() {
    EYEBOX_ASSIGN_OR_RETURN(const State state, Ask({.type = RequestType::kHello}, kBootAttempts));
    if (state.protocol != serial::kProtocolVersion) {
      return DeviceFailed(info_.uri,
                          "speaks version " + std::to_string(state.protocol) + " of the protocol",
                          "load the sketch of this version onto it");
    }
    if (state.bits < 1 || state.bits > 16 || state.minimum_period_us == 0) {
      return DeviceFailed(info_.uri, "describes a converter that cannot be",
                          "load the sketch of this version onto it");
    }
    info_.model = "Arduino";
    info_.significant_bits = state.bits;
    info_.maximum_counts = (int32_t{1} << state.bits) - 1;
    info_.sample_rate_min_hz = 1e6 / 60e6;
    info_.sample_rate_max_hz = 1e6 / state.minimum_period_us;
    info_.can_be_pulse_started = true;
    return absl::OkStatus();
  }

  const PhotodiodeInfo& Info() const override { return info_; }

  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckConfigure(info_, settings));
    Request request = {.type = RequestType::kConfigure};
    if (!settings.pulse_started) {
      request.period_us = static_cast<uint32_t>(std::lround(1e6 / settings.sample_rate_hz));
    }
    EYEBOX_ASSIGN_OR_RETURN(const State state, Ask(request, kAnswerAttempts));
    if (state.period_us != request.period_us) {
      return DeviceFailed(info_.uri,
                          "was asked for a period of " + std::to_string(request.period_us) +
                              " us and reads back " + std::to_string(state.period_us) + " us",
                          "ask for a rate that the board can hold");
    }
    PhotodiodeSettings read_back = settings;
    if (!settings.pulse_started) read_back.sample_rate_hz = 1e6 / state.period_us;
    state_.Configured(read_back);
    return read_back;
  }

  absl::Status Start() override {
    EYEBOX_RETURN_IF_ERROR(state_.Start(clock_->MonotonicNs()));
    const absl::Status started = StartBoard();
    if (!started.ok()) state_.Stop();
    return started;
  }

  absl::StatusOr<SampleBlock> Read(Milliseconds timeout) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckRead());
    const auto deadline = SteadyClock::now() + timeout;
    while (true) {
      EYEBOX_RETURN_IF_ERROR(KeepClocksTogether());
      const Milliseconds wait = std::min(Until(deadline), kAnswerTimeout);
      EYEBOX_ASSIGN_OR_RETURN(std::optional<Arrival> arrival, link_->Next(wait));
      if (arrival) {
        const auto* const samples = std::get_if<Samples>(&arrival->message);
        if (samples != nullptr) return BlockOf(*samples, arrival->monotonic_ns);
        EYEBOX_RETURN_IF_ERROR(NoteAnswer(std::get<State>(arrival->message), *arrival));
      } else if (SteadyClock::now() >= deadline) {
        return state_.Silence(clock_->MonotonicNs());
      }
    }
  }

  absl::Status Stop() override {
    if (!state_.running()) return absl::OkStatus();
    state_.Stop();
    return Ask({.type = RequestType::kStop}, kAnswerAttempts).status();
  }

 private:
  absl::Status StartBoard() {
    for (int i = 0; i < kRoundTripsAtStart; ++i) {
      EYEBOX_RETURN_IF_ERROR(Ask({.type = RequestType::kHello}, kAnswerAttempts).status());
    }
    next_sequence_ = 0;
    EYEBOX_ASSIGN_OR_RETURN(const State state, Ask({.type = RequestType::kStart}, kAnswerAttempts));
    if (state.running) return absl::OkStatus();
    return DeviceFailed(info_.uri, "does not start", "reset the board and open it again");
  }

  // Sends until the answer to it comes; samples that arrive meanwhile are dropped.
  absl::StatusOr<State> Ask(Request request, int attempts) {
    for (int attempt = 0; attempt < attempts; ++attempt) {
      request.token = ++token_;
      sent_ns_ = clock_->MonotonicNs();
      EYEBOX_RETURN_IF_ERROR(link_->Send(request));
      const auto deadline = SteadyClock::now() + kAnswerTimeout;
      while (true) {
        EYEBOX_ASSIGN_OR_RETURN(std::optional<Arrival> arrival, link_->Next(Until(deadline)));
        if (!arrival) break;
        const auto* const state = std::get_if<State>(&arrival->message);
        if (state == nullptr || state->token != token_) continue;
        AddRoundTrip(*state, arrival->monotonic_ns);
        return *state;
      }
    }
    return DeviceFailed(info_.uri,
                        "does not answer (" + std::to_string(link_->damaged_frames()) +
                            " frames came that could not be read)",
                        "check that it is an Arduino with the Eyebox sketch");
  }

  void AddRoundTrip(const State& state, int64_t arrival_ns) {
    clock_map_.AddRoundTrip(unwrap_.DeviceNs(state.micros, arrival_ns), sent_ns_, arrival_ns);
  }

  absl::Status KeepClocksTogether() {
    const int64_t now_ns = clock_->MonotonicNs();
    if (now_ns - sent_ns_ < kRoundTripIntervalNs) return absl::OkStatus();
    sent_ns_ = now_ns;
    return link_->Send({.type = RequestType::kHello, .token = ++token_});
  }

  absl::Status NoteAnswer(const State& state, const Arrival& arrival) {
    if (state.token != token_) return absl::OkStatus();  // an answer too late to be of use
    if (!state.running) return Restarted();
    AddRoundTrip(state, arrival.monotonic_ns);
    return absl::OkStatus();
  }

  absl::Status Restarted() const {
    return DeviceFailed(info_.uri, "restarted while it was running",
                        "check its power supply, then open it again");
  }

  absl::StatusOr<SampleBlock> BlockOf(const Samples& samples, int64_t arrival_ns) {
    const auto ahead =
        static_cast<int32_t>(samples.sequence - static_cast<uint32_t>(next_sequence_));
    if (ahead < 0) return Restarted();
    state_.Heard(clock_->MonotonicNs());
    SampleBlock block = {.sequence = next_sequence_ + static_cast<uint64_t>(ahead),
                         .lost_before = static_cast<uint64_t>(ahead)};
    for (const Samples::Sample& sample : samples.samples) {
      block.device_time_ns.push_back(unwrap_.DeviceNs(sample.micros, arrival_ns));
    }
    clock_map_.AddArrival(block.device_time_ns.back(), arrival_ns);
    for (size_t i = 0; i < samples.samples.size(); ++i) {
      EYEBOX_ASSIGN_OR_RETURN(const auto mapped, clock_map_.Map(block.device_time_ns[i]));
      // The mapping is refined from block to block; time does not run back for it.
      last_ns_ = std::max(mapped.monotonic_ns, last_ns_ + 1);
      const int64_t uncertainty_ns = mapped.uncertainty_ns + (last_ns_ - mapped.monotonic_ns);
      block.time_uncertainty_ns = std::max(block.time_uncertainty_ns, uncertainty_ns);
      block.samples.push_back({.monotonic_ns = last_ns_, .counts = samples.samples[i].counts});
    }
    next_sequence_ = block.sequence + block.samples.size();
    return block;
  }

  PhotodiodeInfo info_;
  PhotodiodeState state_;
  const std::unique_ptr<Link> link_;
  const Clock* const clock_;
  serial::MicrosUnwrapper unwrap_;
  serial::ClockMap clock_map_;
  uint8_t token_ = 0;
  int64_t sent_ns_ = 0;  // when the request with token_ was sent
  int64_t last_ns_ = 0;
  uint64_t next_sequence_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Photodiode>> OpenSerialPhotodiode(const PhotodiodeConfig& config,
                                                                 const Clock* clock) {
  const std::string device = config.uri.substr(kScheme.size());
  if (device.empty()) {
    return BadInput(config.uri, "names no port", "give a URI like serial:/dev/ttyACM0");
  }
  EYEBOX_ASSIGN_OR_RETURN(auto port, serial::Port::Open(device));
  auto photodiode = std::make_unique<SerialPhotodiode>(
      config.uri, std::make_unique<Link>(std::move(port), clock), clock);
  EYEBOX_RETURN_IF_ERROR(photodiode->Meet());
  return photodiode;
}

}  // namespace eyebox::capture
