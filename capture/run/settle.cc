#include "capture/run/settle.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr double kNs = 1e9;

absl::Status CheckAbove(const std::string& field, double value, double least) {
  if (value >= least && std::isfinite(value)) return absl::OkStatus();
  return BadInput("SettleOptions." + field, "is " + std::to_string(value),
                  "give " + std::to_string(least) + " or more");
}

int64_t TimeOf(const FrameMetadata& metadata) {
  return metadata.device_time_ns.value_or(metadata.monotonic_time_ns);
}

}  // namespace

absl::Status SettleOptions::Validate() const {
  EYEBOX_RETURN_IF_ERROR(CheckAbove("least_s", least_s, 0));
  EYEBOX_RETURN_IF_ERROR(CheckAbove("longest_s", longest_s, least_s));
  EYEBOX_RETURN_IF_ERROR(CheckAbove("most_frames", most_frames, 2));
  EYEBOX_RETURN_IF_ERROR(CheckAbove("window_s", window_s, 0));
  EYEBOX_RETURN_IF_ERROR(CheckAbove("agree_sigmas", agree_sigmas, 0));
  return CheckAbove("agree_relative", agree_relative, 0);
}

bool SettleWatch::Add(const FrameMetadata& metadata, const FrameMean& mean) {
  const int64_t now_ns = TimeOf(metadata);
  begin_ns_ = begin_ns_.value_or(now_ns);
  ++settling_.frames;
  settling_.seconds = static_cast<double>(now_ns - *begin_ns_) / kNs;
  const auto is_old = [&](const Seen& seen) {
    return static_cast<double>(now_ns - seen.time_ns) >= options_.window_s * kNs;
  };
  while (window_.size() > 1 && is_old(window_[1])) window_.pop_front();
  const bool comparable = !window_.empty() && is_old(window_.front());
  const bool agrees = comparable && Agrees(window_.front().mean, mean);
  window_.push_back({now_ns, mean});
  if (agrees && settling_.seconds >= options_.least_s) return true;
  return GiveUp();
}

bool SettleWatch::Skip() {
  ++settling_.frames;
  return GiveUp();
}

bool SettleWatch::Agrees(const FrameMean& before, const FrameMean& now) {
  const double change = std::abs(now.mean_dn - before.mean_dn);
  const double sigma = std::hypot(now.sigma_dn, before.sigma_dn);
  const double reading = std::max(now.mean_dn, before.mean_dn);
  settling_.change_relative = reading > 0 ? change / reading : 0;
  return change <= options_.agree_sigmas * sigma + options_.agree_relative * reading;
}

bool SettleWatch::GiveUp() {
  const bool over =
      settling_.seconds >= options_.longest_s || settling_.frames >= options_.most_frames;
  settling_.settled = !over;
  return over;
}

}  // namespace eyebox::capture
