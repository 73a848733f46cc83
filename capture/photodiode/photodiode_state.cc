#include "capture/photodiode/photodiode_state.h"

#include <cmath>

#include "capture/base/status.h"

namespace eyebox::capture {

absl::Status PhotodiodeState::CheckConfigure(const PhotodiodeInfo& info,
                                             const PhotodiodeSettings& settings) const {
  if (running_) return Rejected(uri_, "is running", "stop it before it is configured");
  if (settings.pulse_started) {
    if (info.can_be_pulse_started) return absl::OkStatus();
    return BadInput(uri_ + " pulse_started", "is not possible with this converter",
                    "give a sample rate");
  }
  const double rate_hz = settings.sample_rate_hz;
  if (std::isfinite(rate_hz) && rate_hz >= info.sample_rate_min_hz &&
      rate_hz <= info.sample_rate_max_hz) {
    return absl::OkStatus();
  }
  return BadInput(uri_ + " sample_rate_hz", "is " + std::to_string(rate_hz),
                  "give a value from " + std::to_string(info.sample_rate_min_hz) + " to " +
                      std::to_string(info.sample_rate_max_hz));
}

void PhotodiodeState::Configured(const PhotodiodeSettings& read_back) {
  settings_ = read_back;
  configured_ = true;
}

absl::Status PhotodiodeState::Start(int64_t now_ns) {
  if (!configured_) return Rejected(uri_, "was never configured", "configure it, then start it");
  if (running_) return Rejected(uri_, "is running already", "stop it before it is started again");
  running_ = true;
  heard_ns_ = now_ns;
  return absl::OkStatus();
}

absl::Status PhotodiodeState::CheckRead() const {
  if (running_) return absl::OkStatus();
  return Rejected(uri_, "is not running", "start it before it is read");
}

absl::Status PhotodiodeState::Silence(int64_t now_ns) const {
  const double silent_s = static_cast<double>(now_ns - heard_ns_) * 1e-9;
  if (!settings_.pulse_started && silent_s > 1 + 10 / settings_.sample_rate_hz) {
    return DeviceFailed(uri_, "sent nothing for " + std::to_string(silent_s) + " s",
                        "check cable, power and trigger, then open it again");
  }
  return absl::DeadlineExceededError(Complaint(
      uri_, "no conversion arrived in time",
      settings_.pulse_started ? "check that pulses reach its trigger input" : "wait longer"));
}

}  // namespace eyebox::capture
