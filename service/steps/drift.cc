#include "service/steps/drift.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "capture/run/frame_mean.h"
#include "service/steps/captures.h"

namespace eyebox::service {
namespace {

constexpr double kNs = 1e9;
constexpr double kMinute_s = 60;
constexpr size_t kFewestReferences = 3;
// Of full scale. Above, some pixels may clip and hide drift.
constexpr double kHighestMean = 0.75;

using Entries = std::vector<const capture::CaptureEntry*>;

bool SameSetting(const CaptureSpec& a, const CaptureSpec& b) {
  return a.exposure_s == b.exposure_s && a.gain_db == b.gain_db;
}

// The patch that was read first and all that are like it.
Entries References(const capture::RecordingReader& recording) {
  Entries references = CapturesOfKind(recording, FrameKind::kLight);
  std::erase_if(references,
                [](const auto* entry) { return entry->spec.role != CaptureRole::kReference; });
  std::erase_if(references, [first = references.empty() ? nullptr : references[0]](auto* entry) {
    return !SameSetting(entry->spec, first->spec) || entry->spec.stimulus != first->spec.stimulus;
  });
  return references;
}

struct TimedMean {
  double time_s = 0;
  capture::FrameMean mean;
};

absl::StatusOr<TimedMean> ReadMean(capture::RecordingReader& recording,
                                   const capture::CaptureEntry& entry) {
  std::vector<capture::FrameMean> means;
  EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(entry, [&means](const Frame& frame) {
    means.push_back(capture::MeanOf(frame.view));
    return absl::OkStatus();
  }));
  EYEBOX_ASSIGN_OR_RETURN(const double time_s, TimeOf(recording, {&entry}));
  return TimedMean{time_s, capture::MeanOf(means)};
}

absl::StatusOr<std::optional<double>> DarkMean(capture::RecordingReader& recording,
                                               const CaptureSpec& spec) {
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kDark)) {
    if (!SameSetting(entry->spec, spec)) continue;
    EYEBOX_ASSIGN_OR_RETURN(const TimedMean dark, ReadMean(recording, *entry));
    return dark.mean.mean_dn;
  }
  return std::nullopt;
}

// Empty where the readings can be fitted.
std::string WhyNot(const std::vector<TimedMean>& references, std::optional<double> dark_dn,
                   int significant_bits) {
  if (references.size() < kFewestReferences) {
    return absl::StrCat("there are ", references.size(), " references, and ", kFewestReferences,
                        " or more are needed");
  }
  if (!dark_dn) return "there is no dark frame of the reference's exposure";
  for (size_t i = 0; i < references.size(); ++i) {
    if (i > 0 && references[i].time_s <= references[i - 1].time_s) {
      return "the machine was restarted in between, and the times do not connect";
    }
    const double mean_dn = references[i].mean.mean_dn;
    if (mean_dn > kHighestMean * std::ldexp(1.0, significant_bits)) {
      return "the reference patch comes close to saturation";
    }
    if (mean_dn <= *dark_dn) return "the reference patch is as dark as a dark frame";
  }
  return "";
}

std::string Describe(const optics::Drift& drift) {
  return absl::StrFormat(
      "the display drifted by %.2g %% within %.3g min while it was measured (%+.3g %% +- %.2g %% "
      "per hour on average): every level was corrected to the middle of the recording",
      100 * drift.Span(), 2 * drift.half_span_s / kMinute_s, 100 * drift.per_hour,
      100 * drift.per_hour_sigma);
}

}  // namespace

absl::StatusOr<double> TimeOf(capture::RecordingReader& recording, const Entries& captures) {
  double sum_s = 0;
  for (const capture::CaptureEntry* entry : captures) {
    std::optional<double> first_s;
    const absl::Status status = recording.VisitFrames(*entry, [&first_s](const Frame& frame) {
      first_s = static_cast<double>(frame.metadata.monotonic_time_ns) / kNs;
      return absl::CancelledError("one frame tells the time");
    });
    if (!first_s) return status;
    sum_s += *first_s;
  }
  return sum_s / static_cast<double>(captures.size());
}

absl::StatusOr<MeasuredDrift> MeasureDrift(capture::RecordingReader& recording) {
  MeasuredDrift measured;
  const Entries references = References(recording);
  if (references.empty()) return measured;
  std::vector<TimedMean> means;
  for (const capture::CaptureEntry* entry : references) {
    EYEBOX_ASSIGN_OR_RETURN(means.emplace_back(), ReadMean(recording, *entry));
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto dark_dn, DarkMean(recording, references[0]->spec));
  const std::string obstacle = WhyNot(means, dark_dn, recording.Header().camera.significant_bits);
  if (!obstacle.empty()) {
    measured.warnings.push_back("drift of the display was not looked at: " + obstacle);
    return measured;
  }
  std::vector<optics::DriftReading> readings;
  for (const TimedMean& reference : means) {
    readings.push_back(
        {reference.time_s, reference.mean.mean_dn - *dark_dn, reference.mean.sigma_dn});
  }
  EYEBOX_ASSIGN_OR_RETURN(measured.drift, optics::FitDrift(readings));
  if (measured.drift.order > 0) measured.warnings.push_back(Describe(measured.drift));
  return measured;
}

}  // namespace eyebox::service
