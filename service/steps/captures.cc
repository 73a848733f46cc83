#include "service/steps/captures.h"

#include <algorithm>
#include <optional>
#include <set>

#include "capture/base/status.h"

namespace eyebox::service {
namespace {

bool IsGreyFullField(const StimulusCaptures& group) {
  const Stimulus& stimulus = group.stimulus;
  return stimulus.pattern == StimulusPattern::kFullField && stimulus.drive.has_value() &&
         (*stimulus.drive)[0] == (*stimulus.drive)[1] &&
         (*stimulus.drive)[1] == (*stimulus.drive)[2];
}

std::string SeriesOf(const capture::RecordingReader& recording) {
  std::set<std::string> names;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kLight)) {
    names.insert("\"" + entry->spec.series + "\"");
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

optics::FrameStacker& StackerFor(
    std::vector<std::pair<optics::Setting, optics::FrameStacker>>& stackers,
    const optics::Setting& setting, const optics::SensorRange& range, bool keep_extremes) {
  for (auto& [known, stacker] : stackers) {
    if (optics::SameSetting(known, setting)) return stacker;
  }
  stackers.emplace_back(setting, optics::FrameStacker(setting, range, keep_extremes));
  return stackers.back().second;
}

}  // namespace

std::vector<const capture::CaptureEntry*> CapturesOfKind(const capture::RecordingReader& recording,
                                                         FrameKind kind) {
  std::vector<const capture::CaptureEntry*> found;
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (entry.spec.kind == kind && entry.suspect.empty()) found.push_back(&entry);
  }
  return found;
}

absl::StatusOr<std::vector<StimulusCaptures>> LightCaptures(
    const capture::RecordingReader& recording, const std::string& series) {
  std::vector<StimulusCaptures> groups;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kLight)) {
    if (entry->spec.series != series) continue;
    const auto known = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return group.stimulus == entry->spec.stimulus;
    });
    if (known == groups.end()) {
      groups.push_back({series, entry->spec.stimulus, {entry}});
    } else {
      known->captures.push_back(entry);
    }
  }
  if (groups.empty()) {
    return Missing("series \"" + series + "\"", "the recording holds no light frames of it",
                   "choose one of: " + SeriesOf(recording));
  }
  return groups;
}

absl::StatusOr<std::vector<StimulusCaptures>> GreyLevels(const capture::RecordingReader& recording,
                                                         const std::string& series) {
  EYEBOX_ASSIGN_OR_RETURN(std::vector<StimulusCaptures> groups, LightCaptures(recording, series));
  std::erase_if(groups, [](const auto& group) { return !IsGreyFullField(group); });
  if (groups.empty()) {
    return Rejected("series \"" + series + "\"", "no grey full field with a known drive value",
                    "record full fields of known drive_r = drive_g = drive_b");
  }
  std::sort(groups.begin(), groups.end(), [](const auto& a, const auto& b) {
    return (*a.stimulus.drive)[0] < (*b.stimulus.drive)[0];
  });
  return groups;
}

absl::StatusOr<FrameMetadata> FirstMetadata(capture::RecordingReader& recording,
                                            const capture::CaptureEntry& entry) {
  std::optional<FrameMetadata> first;
  const absl::Status status = recording.VisitFrames(entry, [&first](const Frame& frame) {
    first = frame.metadata;
    return absl::CancelledError("one frame tells");
  });
  if (first) return *first;
  if (!status.ok()) return status;
  return Rejected(entry.file.string(), "it holds no whole frame", "record the stimulus again");
}

absl::StatusOr<std::vector<optics::Stack>> StackCaptures(
    capture::RecordingReader& recording, const std::vector<const capture::CaptureEntry*>& captures,
    double saturation_margin, bool keep_extremes) {
  const optics::SensorRange range{.bits = recording.Header().camera.significant_bits,
                                  .saturation_margin = saturation_margin};
  std::vector<std::pair<optics::Setting, optics::FrameStacker>> stackers;
  for (const capture::CaptureEntry* entry : captures) {
    const optics::Setting setting{entry->spec.exposure_s, entry->spec.gain_db};
    optics::FrameStacker& stacker = StackerFor(stackers, setting, range, keep_extremes);
    EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(*entry, [&](const Frame& frame) {
      return stacker.Add(frame.view, frame.metadata.temperature_degC);
    }));
  }
  std::vector<optics::Stack> stacks;
  for (auto& [setting, stacker] : stackers) {
    EYEBOX_ASSIGN_OR_RETURN(optics::Stack stack, stacker.Finish());
    stacks.push_back(std::move(stack));
  }
  return stacks;
}

int ColourPeriodPx(const capture::RecordingHeader& header) {
  const std::string& format = header.camera.pixel_format;
  // "Mono12p" as GenICam names it; "GREY" and "Y10" as V4L2 does.
  const bool grey = format.starts_with("Mono") || format.starts_with("GREY") ||
                    (format.size() > 1 && format[0] == 'Y' && format[1] >= '0' && format[1] <= '9');
  return grey || header.origin == capture::RecordingOrigin::kSimulated ? 1 : 2;
}

}  // namespace eyebox::service
