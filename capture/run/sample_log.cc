#include "capture/run/sample_log.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/base/clock_triple.h"
#include "capture/base/status.h"
#include "capture/run/frame_check.h"

namespace eyebox::capture {
namespace {

constexpr int kTriples = 2;            // at the beginning and at the end
constexpr double kUnseenFrameS = 0.1;  // beyond its exposure, of a frame before any was taken
constexpr double kMargin = 2;
constexpr double kLongerS = 1;            // starting, stopping, waiting for the last block
constexpr double kMostSamples = 1 << 28;  // 12 GB: what a capture of days would ask for
constexpr int kBlocksAtOnce = 256;        // then the next frame is due, whatever is left
constexpr std::chrono::milliseconds kLastBlock{100};

}  // namespace

absl::Status SampleLog::Prepare() {
  rate_hz_ = 0;
  if (!rig_.photodiode) return absl::OkStatus();
  EYEBOX_RETURN_IF_ERROR(Failed(rig_.photodiode->Stop()));
  const PhotodiodeInfo& info = rig_.photodiode->Info();
  const double rate_hz =
      std::clamp(options_.photodiode_rate_hz, info.sample_rate_min_hz, info.sample_rate_max_hz);
  pulse_started_ = rig_.trigger != nullptr && info.can_be_pulse_started;
  const auto set =
      rig_.photodiode->Configure({.sample_rate_hz = rate_hz, .pulse_started = pulse_started_});
  EYEBOX_RETURN_IF_ERROR(Failed(set.status()));
  if (!pulse_started_) rate_hz_ = set->sample_rate_hz;
  return absl::OkStatus();
}

SideRoom SampleLog::RoomFor(const CaptureSpec& spec) const {
  if (pulse_started_) return {.samples = spec.repeats, .clock_triples = kTriples};
  const double frame_s = spec.exposure_s + std::max(beyond_exposure_s_, kUnseenFrameS);
  const double samples = rate_hz_ * (kMargin * spec.repeats * frame_s + kLongerS);
  return {.samples = static_cast<int64_t>(std::ceil(std::min(samples, kMostSamples))),
          .clock_triples = kTriples};
}

absl::Status SampleLog::Begin(CaptureWriter& capture) {
  samples_ = 0;
  EYEBOX_RETURN_IF_ERROR(AppendTriple(capture));
  begun_ns_ = last_sample_ns_ = options_.clock->MonotonicNs();
  waiting_ = rig_.photodiode != nullptr;
  return waiting_ ? Failed(rig_.photodiode->Start()) : absl::OkStatus();
}

absl::Status SampleLog::Drain(CaptureWriter& capture) {
  bool more = waiting_;
  for (int i = 0; more && i < kBlocksAtOnce; ++i) {
    const int64_t before = samples_;
    EYEBOX_RETURN_IF_ERROR(Read(std::chrono::milliseconds(0), capture));
    more = waiting_ && samples_ > before;
  }
  return absl::OkStatus();
}

absl::Status SampleLog::Finish(const CaptureSpec& spec, int64_t last_frame_ns,
                               CaptureWriter& capture) {
  EYEBOX_RETURN_IF_ERROR(Drain(capture));
  NoteDuration(spec, options_.clock->MonotonicNs());
  // Converters hand over whole buffers: the one that covers the last frame may still be filling.
  const auto period_ns = rate_hz_ > 0 ? static_cast<int64_t>(1e9 / rate_hz_) : 0;
  const auto is_covered = [&] {
    return pulse_started_ ? samples_ >= spec.repeats : last_sample_ns_ + period_ns >= last_frame_ns;
  };
  for (int i = 0; waiting_ && !is_covered() && i < kBlocksAtOnce; ++i) {
    const int64_t before = samples_;
    EYEBOX_RETURN_IF_ERROR(Read(kLastBlock, capture));
    waiting_ &= samples_ > before;
  }
  if (rig_.photodiode) EYEBOX_RETURN_IF_ERROR(Failed(rig_.photodiode->Stop()));
  if (pulse_started_ && samples_ != spec.repeats) {
    return Spoilt(std::to_string(spec.repeats) + " pulses of the trigger gave " +
                  std::to_string(samples_) + " conversions of the photodiode");
  }
  return AppendTriple(capture);
}

// A replay that ended and a wait in vain are no errors: there are no samples to be had.
absl::Status SampleLog::Read(std::chrono::milliseconds timeout, CaptureWriter& capture) {
  const absl::StatusOr<SampleBlock> block = rig_.photodiode->Read(timeout);
  if (absl::IsDeadlineExceeded(block.status())) return absl::OkStatus();
  if (absl::IsOutOfRange(block.status())) {
    waiting_ = false;
    return absl::OkStatus();
  }
  EYEBOX_RETURN_IF_ERROR(Failed(block.status()));
  samples_ += static_cast<int64_t>(block->samples.size());
  last_sample_ns_ = block->samples.back().monotonic_ns;
  return capture.AppendSamples(*block);
}

absl::Status SampleLog::AppendTriple(CaptureWriter& capture) {
  EYEBOX_ASSIGN_OR_RETURN(const ClockTriple triple, SampleClockTriple(*options_.clock, nullptr));
  return capture.AppendClockTriple(triple);
}

absl::Status SampleLog::Failed(const absl::Status& status) const {
  if (!absl::IsUnavailable(status)) return status;
  return Spoilt("the photodiode failed (" + std::string(status.message()) + ")");
}

void SampleLog::NoteDuration(const CaptureSpec& spec, int64_t end_ns) {
  const double frame_s = static_cast<double>(end_ns - begun_ns_) * 1e-9 / spec.repeats;
  beyond_exposure_s_ = std::max(beyond_exposure_s_, frame_s - spec.exposure_s);
}

}  // namespace eyebox::capture
