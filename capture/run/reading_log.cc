#include "capture/run/reading_log.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

bool SameSetting(const CaptureSpec& a, const CaptureSpec& b) {
  return a.exposure_s == b.exposure_s && a.gain_db == b.gain_db;
}

bool Comparable(const CaptureSpec& a, const CaptureSpec& b) {
  return a.kind == FrameKind::kLight && b.kind == FrameKind::kLight && SameSetting(a, b) &&
         a.stimulus.pattern == b.stimulus.pattern &&
         a.stimulus.diameter_deg == b.stimulus.diameter_deg && a.stimulus.drive && b.stimulus.drive;
}

// No channel lower, one higher.
bool IsBrighter(const DriveRgb& a, const DriveRgb& b) {
  return a != b && std::ranges::equal(a, b, [](double x, double y) { return x >= y; });
}

std::string NameOf(const CaptureSpec& spec) {
  const DriveRgb& drive = *spec.stimulus.drive;
  return absl::StrFormat("drive (%.4g, %.4g, %.4g)", drive[0], drive[1], drive[2]);
}

absl::Status CheckNotNegative(const std::string& field, double value) {
  if (value >= 0 && std::isfinite(value)) return absl::OkStatus();
  return BadInput("PlausibilityOptions." + field, "is " + std::to_string(value), "give 0 or more");
}

}  // namespace

absl::Status PlausibilityOptions::Validate() const {
  EYEBOX_RETURN_IF_ERROR(CheckNotNegative("sigmas", sigmas));
  EYEBOX_RETURN_IF_ERROR(CheckNotNegative("relative", relative));
  if (dimmed_relative > 0 && dimmed_relative < 1) return absl::OkStatus();
  return BadInput("PlausibilityOptions.dimmed_relative", "is " + std::to_string(dimmed_relative),
                  "give a fraction above 0 and below 1");
}

std::string ReadingLog::TooBright(const CaptureSpec& spec, const FrameMean& mean) const {
  for (const Reading& other : readings_) {
    if (!Comparable(spec, other.spec) ||
        !IsBrighter(*other.spec.stimulus.drive, *spec.stimulus.drive) ||
        !IsAbove(spec, mean, other.mean)) {
      continue;
    }
    return absl::StrFormat("%s reads %.2f DN, more than capture %d of %s with %.2f DN",
                           NameOf(spec), mean.mean_dn, other.number, NameOf(other.spec),
                           other.mean.mean_dn);
  }
  return "";
}

std::string ReadingLog::EarlierTooBright(const CaptureSpec& spec, const FrameMean& mean) const {
  for (const Reading& other : readings_) {
    if (!Comparable(spec, other.spec) ||
        !IsBrighter(*spec.stimulus.drive, *other.spec.stimulus.drive) ||
        !IsAbove(other.spec, other.mean, mean)) {
      continue;
    }
    return absl::StrFormat("%s reads %.2f DN, less than capture %d of %s with %.2f DN",
                           NameOf(spec), mean.mean_dn, other.number, NameOf(other.spec),
                           other.mean.mean_dn);
  }
  return "";
}

std::string ReadingLog::Dimmed(const CaptureSpec& spec, const FrameMean& mean) const {
  if (spec.role != CaptureRole::kReference) return "";
  const double signal_dn = mean.mean_dn - DarkOf(spec);
  if (signal_dn <= options_.sigmas * mean.sigma_dn) {
    return absl::StrFormat("the reference patch reads %.2f DN, as little as the dark",
                           mean.mean_dn);
  }
  const auto last = std::find_if(readings_.rbegin(), readings_.rend(), [&](const Reading& other) {
    return other.spec.role == CaptureRole::kReference && Comparable(spec, other.spec) &&
           spec.stimulus == other.spec.stimulus;
  });
  if (last == readings_.rend()) return "";
  const double last_dn = last->mean.mean_dn - DarkOf(spec);
  const double sigma_dn = std::hypot(mean.sigma_dn, last->mean.sigma_dn);
  if (last_dn - signal_dn <= options_.dimmed_relative * last_dn + options_.sigmas * sigma_dn) {
    return "";
  }
  return absl::StrFormat("the reference patch lost %.1f %% of its light since capture %d",
                         100 * (1 - signal_dn / last_dn), last->number);
}

int ReadingLog::LastReference() const {
  const auto last = std::find_if(readings_.rbegin(), readings_.rend(), [](const Reading& reading) {
    return reading.spec.role == CaptureRole::kReference;
  });
  return last == readings_.rend() ? 0 : last->number;
}

// What a dark frame of the same setting reads; 0 where none was taken, which makes a lost share of
// the light look smaller than it is.
double ReadingLog::DarkOf(const CaptureSpec& spec) const {
  const auto dark = std::ranges::find_if(readings_, [&](const Reading& reading) {
    return reading.spec.kind == FrameKind::kDark && SameSetting(reading.spec, spec);
  });
  return dark == readings_.end() ? 0 : dark->mean.mean_dn;
}

// By the noise of pixels alone: an afterglow that falls from frame to frame must not excuse itself
// by the scatter that it makes.
bool ReadingLog::IsAbove(const CaptureSpec& spec, const FrameMean& dark_patch,
                         const FrameMean& bright) const {
  const double signal_dn = std::max(bright.mean_dn - DarkOf(spec), 0.0);
  const double sigma_dn = std::hypot(dark_patch.noise_dn, bright.noise_dn);
  return dark_patch.mean_dn - bright.mean_dn >
         options_.sigmas * sigma_dn + options_.relative * signal_dn;
}

}  // namespace eyebox::capture
