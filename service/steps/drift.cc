#include "service/steps/drift.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "service/steps/captures.h"
#include "service/steps/drift_sources.h"

namespace eyebox::service {
namespace {

constexpr double kNs = 1e9;
constexpr double kMinute_s = 60;
constexpr double kAgreementSigmas = 4;
constexpr double kOutlierSigmas = 6;
constexpr double kSmallestOutlier = 0.005;  // relative
constexpr double kMadToSigma = 1.4826;      // of a normal distribution
constexpr double kBeyond = 0.2;             // of half the span of the readings
constexpr size_t kMostOutliers = 3;         // that are named
// Fewer conversions may all fall between two flashes of a display.
constexpr int64_t kFewestConversions = 16;

std::string Describe(const optics::Drift& drift, const std::string& seen_by) {
  return absl::StrFormat(
      "the display drifted by %.2g %% within %.3g min while it was measured (%+.3g %% +- %.2g %% "
      "per hour on average, seen by %s): every level was corrected to the middle of the recording",
      100 * drift.Span(), 2 * drift.half_span_s / kMinute_s, 100 * drift.per_hour,
      100 * drift.per_hour_sigma, seen_by);
}

bool Agree(const optics::Drift& a, const optics::Drift& b) {
  return std::abs(a.per_hour - b.per_hour) <=
         kAgreementSigmas * std::hypot(a.per_hour_sigma, b.per_hour_sigma);
}

std::string Disagreement(const optics::Drift& camera, const optics::Drift& photodiode) {
  return absl::StrFormat(
      "the camera saw the reference patch drift by %+.3g %% +- %.2g %% per hour, the photodiode "
      "saw %+.3g %% +- %.2g %%: one of the two instruments drifts, or they look at parts of the "
      "display that drift apart; the camera's was taken, since it is the camera's levels that are "
      "corrected",
      100 * camera.per_hour, 100 * camera.per_hour_sigma, 100 * photodiode.per_hour,
      100 * photodiode.per_hour_sigma);
}

std::vector<optics::DriftReading> Together(const DriftSource& camera,
                                           const DriftSource& photodiode) {
  std::vector<optics::DriftReading> readings = camera.readings;
  for (optics::DriftReading reading : photodiode.readings) {
    ++reading.series;  // the camera's is 0
    readings.push_back(reading);
  }
  return readings;
}

// Departures of each reading from the mean of its series, without the drift; relative.
std::vector<double> Departures(const std::vector<optics::DriftReading>& readings,
                               const optics::Drift& drift) {
  std::map<int, std::pair<double, double>> sums;
  for (const optics::DriftReading& reading : readings) {
    auto& [sum, count] = sums[reading.series];
    sum += reading.value / drift.FactorAt(reading.time_s);
    count += 1;
  }
  std::vector<double> departures;
  for (const optics::DriftReading& reading : readings) {
    const auto& [sum, count] = sums[reading.series];
    departures.push_back(reading.value / drift.FactorAt(reading.time_s) / (sum / count) - 1);
  }
  return departures;
}

// Captures in which the light was not that of the same stimulus at other times: the display dimmed,
// or had not settled.
void WarnOfOutliers(const DriftSource& photodiode, MeasuredDrift& measured) {
  const std::vector<double> departures = Departures(photodiode.readings, measured.drift);
  std::vector<double> sizes;
  for (const double departure : departures) sizes.push_back(std::abs(departure));
  std::ranges::sort(sizes);
  const double sigma = kMadToSigma * sizes[sizes.size() / 2];
  size_t found = 0;
  for (size_t i = 0; i < departures.size(); ++i) {
    const int64_t conversions = photodiode.captures[i]->sample_count;
    if (conversions > 0 && conversions < kFewestConversions) continue;  // 0: stated by the frames
    if (std::abs(departures[i]) <= std::max(kOutlierSigmas * sigma, kSmallestOutlier)) continue;
    if (++found > kMostOutliers) continue;
    measured.warnings.push_back(absl::StrFormat(
        "the photodiode saw %+.2g %% in capture %d against the mean of its stimulus: the display "
        "changed while it was measured; settle longer, or look at the captures beside it",
        100 * departures[i], photodiode.captures[i]->number));
  }
  if (found > kMostOutliers) {
    measured.warnings.push_back(
        absl::StrCat("likewise in ", found - kMostOutliers, " captures more"));
  }
}

absl::StatusOr<MeasuredDrift> FitOne(const std::vector<optics::DriftReading>& readings,
                                     const std::string& seen_by) {
  MeasuredDrift measured;
  EYEBOX_ASSIGN_OR_RETURN(measured.drift, optics::FitDrift(readings));
  if (measured.drift.order > 0) measured.warnings.push_back(Describe(measured.drift, seen_by));
  return measured;
}

absl::StatusOr<MeasuredDrift> FitBoth(const DriftSource& camera, const DriftSource& photodiode) {
  EYEBOX_ASSIGN_OR_RETURN(MeasuredDrift by_camera, FitOne(camera.readings, "the reference patch"));
  EYEBOX_ASSIGN_OR_RETURN(const optics::Drift by_photodiode, optics::FitDrift(photodiode.readings));
  if (Agree(by_camera.drift, by_photodiode)) {
    return FitOne(Together(camera, photodiode), "the reference patch and the photodiode");
  }
  by_camera.warnings.push_back(Disagreement(by_camera.drift, by_photodiode));
  return by_camera;
}

void WarnOfObstacle(const DriftSource& source, const std::string& who, MeasuredDrift& measured) {
  if (source.obstacle.empty()) return;
  measured.warnings.push_back("drift of the display was not looked at by " + who + ": " +
                              source.obstacle);
}

}  // namespace

absl::StatusOr<double> TimeOf(capture::RecordingReader& recording,
                              const std::vector<const capture::CaptureEntry*>& captures) {
  double sum_s = 0;
  for (const capture::CaptureEntry* entry : captures) {
    EYEBOX_ASSIGN_OR_RETURN(const FrameMetadata first, FirstMetadata(recording, *entry));
    sum_s += static_cast<double>(first.monotonic_time_ns) / kNs;
  }
  return sum_s / static_cast<double>(captures.size());
}

absl::StatusOr<double> CorrectForDrift(capture::RecordingReader& recording,
                                       const std::vector<const capture::CaptureEntry*>& captures,
                                       const optics::Drift& drift,
                                       optics::LuminanceImage& luminance) {
  if (drift.order == 0) return 0.0;
  EYEBOX_ASSIGN_OR_RETURN(const double time_s, TimeOf(recording, captures));
  optics::CorrectDrift(drift, time_s, luminance);
  return drift.SigmaAt(time_s) / drift.FactorAt(time_s);
}

absl::StatusOr<bool> IsBeyondDrift(capture::RecordingReader& recording,
                                   const std::vector<const capture::CaptureEntry*>& captures,
                                   const optics::Drift& drift) {
  if (drift.order == 0) return false;
  EYEBOX_ASSIGN_OR_RETURN(const double time_s, TimeOf(recording, captures));
  return time_s < drift.first_s - kBeyond * drift.half_span_s ||
         time_s > drift.first_s + (2 + kBeyond) * drift.half_span_s;
}

absl::StatusOr<std::optional<double>> CorrectForDriftWithin(
    capture::RecordingReader& recording, const std::vector<const capture::CaptureEntry*>& captures,
    const optics::Drift& drift, optics::LuminanceImage& luminance) {
  EYEBOX_ASSIGN_OR_RETURN(const bool beyond, IsBeyondDrift(recording, captures, drift));
  if (beyond) return std::nullopt;
  return CorrectForDrift(recording, captures, drift, luminance);
}

absl::StatusOr<MeasuredDrift> MeasureDrift(capture::RecordingReader& recording) {
  EYEBOX_ASSIGN_OR_RETURN(const DriftSource camera, CameraReferences(recording));
  EYEBOX_ASSIGN_OR_RETURN(const DriftSource photodiode, PhotodiodeReadings(recording));
  const bool camera_tells = camera.present && camera.obstacle.empty();
  const bool photodiode_tells = photodiode.present && photodiode.obstacle.empty();
  MeasuredDrift measured;
  if (camera_tells && photodiode_tells) {
    EYEBOX_ASSIGN_OR_RETURN(measured, FitBoth(camera, photodiode));
  } else if (camera_tells) {
    EYEBOX_ASSIGN_OR_RETURN(measured, FitOne(camera.readings, "the reference patch"));
  } else if (photodiode_tells) {
    EYEBOX_ASSIGN_OR_RETURN(measured, FitOne(photodiode.readings, "the photodiode"));
  }
  WarnOfObstacle(camera, "the camera", measured);
  WarnOfObstacle(photodiode, "the photodiode", measured);
  if (photodiode_tells) WarnOfOutliers(photodiode, measured);
  return measured;
}

}  // namespace eyebox::service
