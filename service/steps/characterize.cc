#include "service/steps/characterize.h"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/sensor/emva1288/descriptor.h"
#include "optics/sensor/emva1288/photon_transfer_steps.h"
#include "optics/sensor/emva1288/read_series.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

constexpr int kColourPeriodPx = 2;           // suits a Bayer mosaic and grey
constexpr size_t kFewestFlatExposures = 10;  // for a series of flats alone
constexpr double kReferenceFraction = 0.5;   // of full scale, for the exposure that fixes a group

// Captures of one setting and stimulus.
struct CaptureSet {
  optics::SetCondition condition;
  std::vector<const capture::CaptureEntry*> captures;
};

bool SameLight(const CaptureSpec& a, const CaptureSpec& b) {
  return a.kind == b.kind && a.series == b.series && a.stimulus == b.stimulus &&
         a.luminance_cd_m2 == b.luminance_cd_m2;
}

size_t ExposuresOf(const capture::RecordingReader& recording, FrameKind kind) {
  std::set<double> exposures;
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (entry.spec.kind == kind) exposures.insert(entry.spec.exposure_s);
  }
  return exposures.size();
}

bool IsWanted(const CaptureSpec& spec, bool flats_only) {
  if (spec.kind != FrameKind::kLight) return true;
  return !flats_only && spec.stimulus.pattern == StimulusPattern::kFullField;
}

// One set per light and exposure, of the gain of the first dark.
std::vector<CaptureSet> SetsOf(const capture::RecordingReader& recording, bool flats_only) {
  std::vector<CaptureSet> sets;
  std::vector<const CaptureSpec*> lights;  // index is the group
  const auto captures = recording.Captures();
  const auto first_dark = std::find_if(captures.begin(), captures.end(), [](const auto& entry) {
    return entry.spec.kind == FrameKind::kDark;
  });
  if (first_dark == captures.end()) return sets;
  const double gain_db = first_dark->spec.gain_db;
  for (const capture::CaptureEntry& entry : captures) {
    const CaptureSpec& spec = entry.spec;
    if (!IsWanted(spec, flats_only) || spec.gain_db != gain_db) continue;
    const bool dark = spec.kind == FrameKind::kDark;
    int group = 0;
    if (!dark) {
      const auto known = std::find_if(lights.begin(), lights.end(),
                                      [&](const auto* other) { return SameLight(*other, spec); });
      group = static_cast<int>(known - lights.begin());
      if (known == lights.end()) lights.push_back(&spec);
    }
    const auto same = std::find_if(sets.begin(), sets.end(), [&](const CaptureSet& set) {
      return set.condition.dark == dark && set.condition.group == group &&
             set.condition.exposure_s == spec.exposure_s;
    });
    if (same != sets.end()) {
      same->captures.push_back(&entry);
      continue;
    }
    optics::SetCondition condition;
    condition.where = entry.file.string();
    condition.dark = dark;
    condition.exposure_s = spec.exposure_s;
    condition.gain_db = gain_db;
    condition.group = group;
    sets.push_back({condition, {&entry}});
  }
  return sets;
}

absl::StatusOr<optics::SetAccumulator::Finished> ReadSet(capture::RecordingReader& recording,
                                                         const CaptureSet& set,
                                                         const optics::PixelRegion& region) {
  optics::SetAccumulator accumulator(
      set.condition, {.bits = recording.Header().camera.significant_bits}, kColourPeriodPx, region);
  double temperature_sum = 0;
  int temperatures = 0;
  for (const capture::CaptureEntry* entry : set.captures) {
    EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(*entry, [&](const Frame& frame) {
      if (frame.metadata.temperature_degC) {
        temperature_sum += *frame.metadata.temperature_degC;
        ++temperatures;
      }
      return accumulator.Add(frame.view);
    }));
  }
  if (temperatures > 0 && temperatures == accumulator.images()) {
    accumulator.condition().temperature_degC = temperature_sum / temperatures;
  }
  return accumulator.Finish();
}

optics::PixelRegion MiddleThird(ImageSize frame) {
  const auto side = [](int length) { return std::min(length, std::max(length / 3, 12)); };
  const ImageSize size{side(frame.width_px), side(frame.height_px)};
  return {(frame.width_px - size.width_px) / 2, (frame.height_px - size.height_px) / 2, size};
}

// Signal per second above its dark; negative where the set has none.
double RateOf(const optics::SetStatistics& set,
              const std::vector<const optics::SetStatistics*>& darks) {
  const auto* dark = optics::DarkOf(darks, set.condition.exposure_s);
  return dark == nullptr ? -1 : (set.mean_dn - dark->mean_dn) / set.condition.exposure_s;
}

// Irradiation = exposure times the rate of the group's reference exposure: the brightest below half
// of full scale, else the shortest. A group that saturates even that one is left out.
void ScaleGroups(std::vector<optics::SetStatistics>& sets, double full_scale_dn) {
  std::set<int> saturated_groups;
  std::vector<const optics::SetStatistics*> darks;
  for (const auto& set : sets) {
    if (set.condition.dark) darks.push_back(&set);
  }
  const auto is_better = [&](const optics::SetStatistics& a, const optics::SetStatistics& b) {
    const bool a_below = a.mean_dn < kReferenceFraction * full_scale_dn;
    const bool b_below = b.mean_dn < kReferenceFraction * full_scale_dn;
    if (a_below != b_below) return a_below;
    return a_below ? a.mean_dn > b.mean_dn : a.mean_dn < b.mean_dn;
  };
  for (auto& set : sets) {
    if (set.condition.dark) continue;
    const optics::SetStatistics* reference = &set;
    for (const auto& other : sets) {
      if (other.condition.dark || other.condition.group != set.condition.group) continue;
      if (is_better(other, *reference)) reference = &other;
    }
    if (reference->saturated_share > 0) saturated_groups.insert(set.condition.group);
    set.condition.irradiation = std::max(RateOf(*reference, darks), 0.0) * set.condition.exposure_s;
  }
  std::erase_if(sets, [&](const optics::SetStatistics& set) {
    return !set.condition.dark && saturated_groups.contains(set.condition.group);
  });
}

}  // namespace

absl::StatusOr<CharacterizedSensor> CharacterizeDescriptor(const std::filesystem::path& descriptor,
                                                           const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const optics::Emva1288Descriptor described,
                          optics::ReadEmva1288Descriptor(descriptor));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "reading the images"));
  EYEBOX_ASSIGN_OR_RETURN(const optics::SeriesCollector series,
                          optics::ReadSeries(described, descriptor.string()));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "figures of the standard"));
  CharacterizedSensor result;
  auto sensor = optics::CharacteriseSensor(series);
  if (!sensor.ok()) return Within(descriptor, sensor.status());
  result.sensor = *std::move(sensor);
  result.source = descriptor.filename().string();
  result.irradiation_unit = "photon";
  result.bits = described.bits;
  result.sensor.identity.bits = described.bits;
  result.region = {0, 0, described.size};
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

absl::StatusOr<CharacterizedSensor> CharacterizeCaptures(capture::RecordingReader& recording,
                                                         const Watcher& watcher) {
  const bool flats = ExposuresOf(recording, FrameKind::kFlat) >= kFewestFlatExposures;
  const std::vector<CaptureSet> sets = SetsOf(recording, flats);
  if (sets.empty()) {
    return Rejected("recording", "it holds no dark frames",
                    "record darks of every exposure with the lens covered");
  }
  CharacterizedSensor result;
  result.region = MiddleThird(sets[0].captures[0]->frame_size);
  const capture::CameraInfo& camera = recording.Header().camera;
  result.bits = camera.significant_bits;
  result.irradiation_unit = "DN";
  optics::SeriesCollector series;
  for (size_t k = 0; k < sets.size(); ++k) {
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(
        0.9 * static_cast<double>(k) / static_cast<double>(sets.size()), "reading the frames"));
    EYEBOX_ASSIGN_OR_RETURN(optics::SetAccumulator::Finished set,
                            ReadSet(recording, sets[k], result.region));
    series.Add(std::move(set));
  }
  ScaleGroups(series.sets, optics::SensorRange{result.bits}.FullScaleDn());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "figures of the standard"));
  EYEBOX_ASSIGN_OR_RETURN(
      result.sensor,
      optics::CharacteriseSensor(series, {.photons_known = false, .pairs_are_temporal = false}));
  result.sensor.identity = {camera.model, camera.serial, camera.pixel_format, result.bits};
  if (!flats) {
    result.sensor.emva.warnings.push_back(
        "fewer than ten exposures of flats: full fields of the display take part, whose own fine "
        "structure may be in PRNU1288 and in the defect map");
  }
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

absl::StatusOr<CharacterizedSensor> CharacterizeRecording(const std::filesystem::path& recording,
                                                          const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  auto result = CharacterizeCaptures(*reader, watcher);
  if (!result.ok()) return Within(recording, result.status());
  result->source = (recording / ".").lexically_normal().parent_path().filename().string();
  return result;
}

}  // namespace eyebox::service
