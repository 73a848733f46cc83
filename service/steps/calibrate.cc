#include "service/steps/calibrate.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "optics/reduce/interpolate_dark.h"
#include "optics/reduce/match_dark.h"
#include "optics/reduce/reduce_level.h"
#include "optics/sensor/photon_transfer.h"
#include "service/steps/captures.h"
#include "service/steps/sensor.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

constexpr double kSameTemperatureK = 1;  // of darks that are averaged

using Entries = std::vector<const capture::CaptureEntry*>;

// By temperature, coldest first; each spans 1 K at most. Those that tell none come first, together.
absl::StatusOr<std::vector<Entries>> ByTemperature(capture::RecordingReader& recording,
                                                   const Entries& captures) {
  std::vector<std::pair<std::optional<double>, const capture::CaptureEntry*>> known;
  for (const capture::CaptureEntry* entry : captures) {
    if (entry->frame_count == 0) continue;  // it stopped before its first frame
    EYEBOX_ASSIGN_OR_RETURN(const FrameMetadata first, FirstMetadata(recording, *entry));
    const bool told = first.temperature_degC && std::isfinite(*first.temperature_degC);
    known.emplace_back(told ? first.temperature_degC : std::nullopt, entry);
  }
  std::ranges::stable_sort(known, {}, [](const auto& dark) { return dark.first; });
  std::vector<Entries> groups;
  std::optional<double> coldest;
  for (const auto& [temperature, entry] : known) {
    const bool apart = temperature && (!coldest || *temperature > *coldest + kSameTemperatureK);
    if (groups.empty() || apart) {
      groups.emplace_back();
      coldest = temperature;
    }
    groups.back().push_back(entry);
  }
  return groups;
}

absl::StatusOr<std::vector<optics::Stack>> StackDarks(capture::RecordingReader& recording) {
  const auto captures = CapturesOfKind(recording, FrameKind::kDark);
  if (captures.empty()) {
    return Rejected("recording", "it holds no dark frames",
                    "record darks of every exposure with the lens covered");
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto groups, ByTemperature(recording, captures));
  std::vector<optics::Stack> darks;
  for (const Entries& group : groups) {
    EYEBOX_ASSIGN_OR_RETURN(auto stacks, StackCaptures(recording, group));
    std::ranges::move(stacks, std::back_inserter(darks));
  }
  return darks;
}

absl::StatusOr<optics::NoiseModel> MeasureNoise(capture::RecordingReader& recording,
                                                const std::vector<optics::Stack>& darks,
                                                const optics::DefectMap& defects,
                                                const Watcher& watcher) {
  const auto shortest = std::min_element(darks.begin(), darks.end(), [](auto& a, auto& b) {
    return a.setting.exposure_s < b.setting.exposure_s;
  });
  optics::PhotonTransfer transfer(*shortest, defects.defective,
                                  {.colour_period_px = ColourPeriodPx(recording.Header())});
  const auto captures = recording.Captures();
  for (size_t i = 0; i < captures.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(
        watcher.Reach(static_cast<double>(i) / static_cast<double>(captures.size()),
                      "noise and gain from repeated frames"));
    transfer.BeginCapture(captures[i].spec.kind);
    EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(
        captures[i], [&](const Frame& frame) { return transfer.AddFrame(frame.view); }));
  }
  return transfer.Fit();
}

absl::Status TakeSensor(const capture::RecordingReader& recording, const optics::Setting& setting,
                        const std::filesystem::path& folder, optics::Calibration& calibration) {
  EYEBOX_ASSIGN_OR_RETURN(const optics::SensorCharacterisation sensor,
                          ReadSensorOf(recording.Header().camera, folder));
  calibration.noise.gain_db = setting.gain_db;
  const absl::Status applied = optics::ApplySensor(sensor, calibration);
  return applied.ok() ? applied : Within(folder, applied);
}

// Darks of the settings of lights and flats that have none of their own.
void CompleteDarks(const capture::RecordingReader& recording, optics::Calibration& calibration) {
  const size_t recorded = calibration.darks.size();
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (entry.spec.kind == FrameKind::kDark || !entry.suspect.empty()) continue;
    const optics::Setting setting{entry.spec.exposure_s, entry.spec.gain_db};
    const bool refused = std::ranges::any_of(calibration.refused_darks, [&](const auto& known) {
      return optics::SameSetting(known.first, setting);
    });
    if (refused || optics::FindDark(calibration, setting).ok()) continue;
    auto dark = optics::InterpolateDark(std::span(calibration.darks).first(recorded),
                                        calibration.defects.defective, setting);
    if (dark.ok()) {
      calibration.darks.push_back(*std::move(dark));
    } else {
      calibration.refused_darks.emplace_back(setting, dark.status().message());
    }
  }
}

std::optional<optics::KnownLuminance> LuminanceOf(const CaptureSpec& spec) {
  if (!spec.luminance_cd_m2) return std::nullopt;
  return optics::KnownLuminance{*spec.luminance_cd_m2, spec.luminance_relative_sigma.value_or(0)};
}

absl::StatusOr<std::optional<optics::FlatField>> MeasureFlatOf(
    capture::RecordingReader& recording, const optics::Calibration& calibration) {
  const auto captures = CapturesOfKind(recording, FrameKind::kFlat);
  if (captures.empty()) return std::nullopt;
  for (const capture::CaptureEntry* entry : captures) {
    if (entry->spec.luminance_cd_m2 != captures[0]->spec.luminance_cd_m2) {
      return Rejected(entry->file.string(), "its flat has another luminance than the first flat",
                      "record all flats at one luminance");
    }
  }
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks,
                          StackCaptures(recording, captures, calibration.saturation_margin));
  EYEBOX_ASSIGN_OR_RETURN(
      optics::FlatField flat,
      optics::MeasureFlat(stacks, calibration, LuminanceOf(captures[0]->spec),
                          {.colour_period_px = ColourPeriodPx(recording.Header())}));
  return flat;
}

}  // namespace

absl::StatusOr<optics::Calibration> CalibrateCamera(capture::RecordingReader& recording,
                                                    const Watcher& watcher,
                                                    const std::filesystem::path& sensor_folder) {
  optics::Calibration calibration;
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "dark frames and hot pixels"));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<optics::Stack> darks, StackDarks(recording));
  EYEBOX_ASSIGN_OR_RETURN(calibration.defects, optics::FindHotPixels(darks));
  if (sensor_folder.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(calibration.noise, MeasureNoise(recording, darks, calibration.defects,
                                                            watcher.Part(0.1, 0.9)));
  } else {
    EYEBOX_RETURN_IF_ERROR(TakeSensor(recording, darks[0].setting, sensor_folder, calibration));
  }
  for (const optics::Stack& dark : darks) {
    EYEBOX_ASSIGN_OR_RETURN(optics::DarkFrame frame, optics::MeasureDark(dark, calibration.noise));
    calibration.darks.push_back(std::move(frame));
  }
  optics::StateDarkCurrents(calibration);
  CompleteDarks(recording, calibration);
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "flat field and luminance scale"));
  EYEBOX_ASSIGN_OR_RETURN(calibration.flat, MeasureFlatOf(recording, calibration));
  return calibration;
}

}  // namespace eyebox::service
