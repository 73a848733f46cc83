#include "service/steps/drift_sources.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "capture/run/frame_mean.h"
#include "service/steps/captures.h"
#include "service/steps/drift.h"
#include "service/steps/photodiode.h"

namespace eyebox::service {
namespace {

constexpr size_t kFewestReferences = 3;
// Of full scale. Above, some pixels may clip and hide drift.
constexpr double kHighestMean = 0.75;
// A scatter that is learnt from fewer degrees of freedom may be anything.
constexpr size_t kFewestDegrees = 4;
constexpr double kDimmest = 0.1;  // of the brightest reading
constexpr double kQuantisationCounts = 0.29;
// Less above the zero, in counts and as a share of it, is none.
constexpr double kLeastSignalCounts = 3;
constexpr double kLeastSignal = 0.01;
constexpr int kScatterSteps = 4;

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

absl::StatusOr<capture::FrameMean> MeanOfCapture(capture::RecordingReader& recording,
                                                 const capture::CaptureEntry& entry) {
  std::vector<capture::FrameMean> means;
  EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(entry, [&means](const Frame& frame) {
    means.push_back(capture::MeanOf(frame.view));
    return absl::OkStatus();
  }));
  return capture::MeanOf(means);
}

absl::StatusOr<std::optional<double>> DarkMean(capture::RecordingReader& recording,
                                               const CaptureSpec& spec) {
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kDark)) {
    if (!SameSetting(entry->spec, spec)) continue;
    EYEBOX_ASSIGN_OR_RETURN(const capture::FrameMean dark, MeanOfCapture(recording, *entry));
    return dark.mean_dn;
  }
  return std::nullopt;
}

bool TimesAscend(const std::vector<optics::DriftReading>& readings) {
  return std::ranges::is_sorted(readings, std::less_equal<>(), &optics::DriftReading::time_s);
}

// Empty where the readings, which hold whole means yet, can be fitted.
std::string WhyNot(const std::vector<optics::DriftReading>& readings, std::optional<double> dark_dn,
                   int significant_bits) {
  if (readings.size() < kFewestReferences) {
    return absl::StrCat("there are ", readings.size(), " references, and ", kFewestReferences,
                        " or more are needed");
  }
  if (!dark_dn) return "there is no dark frame of the reference's exposure";
  if (!TimesAscend(readings)) {
    return "the machine was restarted in between, and the times do not connect";
  }
  for (const optics::DriftReading& reading : readings) {
    if (reading.value > kHighestMean * std::ldexp(1.0, significant_bits)) {
      return "the reference patch comes close to saturation";
    }
    if (reading.value <= *dark_dn) return "the reference patch is as dark as a dark frame";
  }
  return "";
}

// What the photodiode reads without light; none where it was not read during a dark.
absl::StatusOr<std::optional<double>> PhotodiodeZero(capture::RecordingReader& recording) {
  double sum = 0;
  double count = 0;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kDark)) {
    EYEBOX_ASSIGN_OR_RETURN(const auto mean, ReadPhotodiode(recording, *entry));
    if (!mean) continue;
    sum += mean->counts * static_cast<double>(mean->readings);
    count += static_cast<double>(mean->readings);
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

// All that was read, one series a stimulus; sigma is 1 / sqrt(conversions) yet.
absl::Status ReadStimuli(capture::RecordingReader& recording, DriftSource& source) {
  std::vector<Stimulus> stimuli;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kLight)) {
    if (!entry->spec.stimulus.drive) continue;
    EYEBOX_ASSIGN_OR_RETURN(const auto mean, ReadPhotodiode(recording, *entry));
    if (!mean && !source.present) return absl::OkStatus();  // looking into all would take long
    if (!mean) continue;
    source.present = true;
    if (mean->clipped) continue;
    const auto known = std::ranges::find(stimuli, entry->spec.stimulus);
    const auto series = static_cast<int>(known - stimuli.begin());
    if (known == stimuli.end()) stimuli.push_back(entry->spec.stimulus);
    EYEBOX_ASSIGN_OR_RETURN(const double time_s, TimeOf(recording, {entry}));
    source.readings.push_back(
        {time_s, mean->counts, 1 / std::sqrt(static_cast<double>(mean->readings)), series});
    source.captures.push_back(entry);
  }
  return absl::OkStatus();
}

// Readings above the zero, without dim ones. False if none stands out from the zero.
bool KeepBright(double zero_counts, DriftSource& source) {
  double brightest = 0;
  for (optics::DriftReading& reading : source.readings) {
    reading.value -= zero_counts;
    brightest = std::max(brightest, reading.value);
  }
  if (brightest <= std::max(kLeastSignalCounts, kLeastSignal * std::abs(zero_counts))) return false;
  DriftSource kept{.present = source.present};
  for (size_t i = 0; i < source.readings.size(); ++i) {
    if (source.readings[i].value <= kDimmest * brightest) continue;
    kept.readings.push_back(source.readings[i]);
    kept.captures.push_back(source.captures[i]);
  }
  source = std::move(kept);
  return true;
}

size_t DegreesOf(const std::vector<optics::DriftReading>& readings) {
  std::set<int> series;
  for (const optics::DriftReading& reading : readings) series.insert(reading.series);
  return readings.size() - std::min(readings.size(), series.size() + 1);
}

// Sigmas in proportion to the square root of the light, between the noise of a converter, which
// does not know of it, and that of a display that flashes, which is a share of it.
absl::Status LearnScatter(std::vector<optics::DriftReading>& readings) {
  std::vector<double> floors;
  for (optics::DriftReading& reading : readings) {
    floors.push_back(kQuantisationCounts * reading.sigma);
    reading.sigma = std::max(reading.sigma * std::sqrt(reading.value), floors.back());
  }
  for (int step = 0; step < kScatterSteps; ++step) {
    EYEBOX_ASSIGN_OR_RETURN(const optics::Drift drift, optics::FitDrift(readings));
    for (size_t i = 0; i < readings.size(); ++i) {
      readings[i].sigma = std::max(readings[i].sigma * std::sqrt(drift.reduced_chi2), floors[i]);
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DriftSource> CameraReferences(capture::RecordingReader& recording) {
  DriftSource source;
  source.captures = References(recording);
  source.present = !source.captures.empty();
  if (!source.present) return source;
  for (const capture::CaptureEntry* entry : source.captures) {
    EYEBOX_ASSIGN_OR_RETURN(const capture::FrameMean mean, MeanOfCapture(recording, *entry));
    EYEBOX_ASSIGN_OR_RETURN(const double time_s, TimeOf(recording, {entry}));
    source.readings.push_back({time_s, mean.mean_dn, mean.sigma_dn});
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto dark_dn, DarkMean(recording, source.captures[0]->spec));
  source.obstacle = WhyNot(source.readings, dark_dn, recording.Header().camera.significant_bits);
  if (!source.obstacle.empty()) return source;
  for (optics::DriftReading& reading : source.readings) reading.value -= *dark_dn;
  return source;
}

absl::StatusOr<DriftSource> PhotodiodeReadings(capture::RecordingReader& recording) {
  DriftSource source;
  EYEBOX_RETURN_IF_ERROR(ReadStimuli(recording, source));
  if (!source.present) return source;
  EYEBOX_ASSIGN_OR_RETURN(const auto zero_counts, PhotodiodeZero(recording));
  if (!zero_counts) {
    source.obstacle = "it was not read during the darks, which tell its zero";
    return source;
  }
  if (source.readings.empty()) {
    source.obstacle = "all its readings are clipped: lower its gain";
  } else if (!KeepBright(*zero_counts, source)) {
    source.obstacle = "it reads the same with light and without";
  } else if (DegreesOf(source.readings) < kFewestDegrees) {
    source.obstacle = "too few stimuli were read more than once";
  } else if (!TimesAscend(source.readings)) {
    source.obstacle = "its readings have no times that ascend, as after a restart of the machine";
  } else {
    EYEBOX_RETURN_IF_ERROR(LearnScatter(source.readings));
  }
  return source;
}

}  // namespace eyebox::service
