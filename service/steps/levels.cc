#include "service/steps/levels.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "optics/reduce/clip_stack.h"
#include "optics/reduce/flat_variance.h"
#include "optics/uniformity/cross_validate.h"
#include "service/steps/drift.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

// A level that lost more of the field than this says nothing about the field.
constexpr double kLargestInvalidShare = 0.5;
constexpr int kBlocksAlong = 24;

double DriveOf(const StimulusCaptures& group) { return (*group.stimulus.drive)[0]; }

std::string NameOf(const StimulusCaptures& group) {
  return absl::StrFormat("grey level, drive %.6g", DriveOf(group));
}

bool IsUsable(const optics::ReducedLevel& level) {
  const Image<uint8_t>& mask = level.luminance.image.mask;
  const std::vector<size_t> disk = ReferenceDiskPixels(mask.size());
  return level.report.invalid_share <= kLargestInvalidShare &&
         std::any_of(disk.begin(), disk.end(), [&](size_t i) { return mask.pixels()[i] == 0; });
}

std::string WhyUnusable(const StimulusCaptures& group, const optics::ReducedLevel& level) {
  return absl::StrFormat(
      "%s was left out: %.1f %% of the pixels saturate in every exposure and %.1f %% are dark in "
      "every exposure; add a %s exposure",
      NameOf(group), 100 * level.report.all_saturated_share, 100 * level.report.all_dark_share,
      level.report.all_saturated_share >= level.report.all_dark_share ? "shorter" : "longer");
}

absl::Status NoUsableLevel(const std::vector<std::string>& reasons) {
  return Rejected("grey levels", absl::StrCat("none is usable: ", absl::StrJoin(reasons, "; ")),
                  "record them again");
}

absl::Status InLevel(const StimulusCaptures& group, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(NameOf(group), ": ", status.message()));
}

void AddToStack(const optics::ReducedLevel& level, double drive,
                const optics::Calibration& calibration, MeasuredLevels& levels) {
  const optics::MeasuredImage& image = level.luminance.image;
  levels.blocks.push_back(
      {drive, optics::Binned(optics::WithoutFlat(image, calibration), LevelBlockPx(image.size()))});
  const auto values = image.value.pixels();
  levels.size = image.size();
  levels.drives.push_back(drive);
  const size_t held = levels.luminance.size();
  levels.luminance.resize(held + values.size());
  ForEachPieceInParallel(values.size(), [&](size_t first, size_t end) {
    std::copy(values.begin() + first, values.begin() + end,
              levels.luminance.begin() + static_cast<std::ptrdiff_t>(held + first));
  });
  levels.valid.resize(values.size(), 1);
  for (size_t i = 0; i < values.size(); ++i) {
    if (image.mask.pixels()[i] != 0) levels.valid[i] = 0;
  }
}

}  // namespace

absl::StatusOr<std::string> ChooseSeries(const capture::RecordingReader& recording,
                                         const std::optional<std::string>& asked) {
  if (asked) return *asked;
  std::set<std::string> names;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kLight)) {
    names.insert(entry->spec.series);
  }
  if (names.empty() || names.contains("")) return "";
  if (names.size() == 1) return *names.begin();
  return Missing("main series", "the recording holds none, but several others",
                 "choose one with --series: " + absl::StrJoin(names, ", "));
}

absl::StatusOr<optics::ReducedLevel> ReduceCaptures(capture::RecordingReader& recording,
                                                    const StimulusCaptures& group,
                                                    const optics::Calibration& calibration,
                                                    const BracketOptions& options) {
  const bool clip = options.clip_sigmas > 0;
  EYEBOX_ASSIGN_OR_RETURN(
      auto stacks, StackCaptures(recording, group.captures, calibration.saturation_margin, clip));
  std::string clipped;
  for (optics::Stack& stack : stacks) {
    if (!clip) break;
    EYEBOX_ASSIGN_OR_RETURN(
        stack, optics::ClipStack(std::move(stack), calibration.noise, options.clip_sigmas));
    size_t rejected = 0;
    for (const uint8_t count : stack.rejected_count.pixels()) rejected += count;
    absl::StrAppend(&clipped, clipped.empty() ? "" : ", ", rejected, " counts of ",
                    optics::Describe(stack.setting));
  }
  EYEBOX_ASSIGN_OR_RETURN(
      optics::ReducedLevel level,
      optics::ReduceLevel(stacks, calibration,
                          {.colour_period_px = ColourPeriodPx(recording.Header()),
                           .repair_defects = options.repair_defects}));
  if (clip) {
    auto& history = level.luminance.image.history;
    history.insert(history.begin(), absl::StrFormat("ClipStack(%g sigma, left out %s)",
                                                    options.clip_sigmas, clipped));
  }
  return level;
}

int LevelBlockPx(ImageSize size) {
  return std::max(1, std::max(size.width_px, size.height_px) / kBlocksAlong);
}

absl::StatusOr<MeasuredLevels> ReduceGreyLevels(capture::RecordingReader& recording,
                                                const std::string& series,
                                                const optics::Calibration& calibration,
                                                const Watcher& watcher, const KnownGlare& glare,
                                                const BracketOptions& bracket) {
  EYEBOX_ASSIGN_OR_RETURN(const auto groups, GreyLevels(recording, series));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredDrift drift, MeasureDrift(recording));
  MeasuredLevels levels;
  std::vector<DiskReading> readings;
  int beyond = 0;                   // the readings of the drift
  double scale_relative_sigma = 0;  // without that of the drift, which differs between levels
  for (size_t i = 0; i < groups.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(
        watcher.Reach(static_cast<double>(i) / static_cast<double>(groups.size()),
                      absl::StrFormat("luminance of %d levels", groups.size())));
    auto reduced = ReduceCaptures(recording, groups[i], calibration, bracket);
    if (!reduced.ok()) return InLevel(groups[i], reduced.status());
    if (!IsUsable(*reduced)) {
      levels.warnings.push_back(WhyUnusable(groups[i], *reduced));
      continue;
    }
    EYEBOX_ASSIGN_OR_RETURN(const auto figures, TakeScatterOut(glare, *reduced));
    const double drive = DriveOf(groups[i]);
    scale_relative_sigma = reduced->luminance.scale_relative_sigma;
    EYEBOX_ASSIGN_OR_RETURN(
        const double drift_sigma,
        CorrectForDrift(recording, groups[i].captures, drift.drift, reduced->luminance));
    EYEBOX_ASSIGN_OR_RETURN(const bool is_beyond,
                            IsBeyondDrift(recording, groups[i].captures, drift.drift));
    beyond += is_beyond ? 1 : 0;
    readings.push_back(ReadReferenceDisk(reduced->luminance, calibration, drive));
    readings.back().relative_sigma = drift_sigma;
    levels.shares.push_back({reduced->report.budget, drift_sigma});
    if (levels.drives.empty()) {  // the least that will do: growing would copy the stack
      levels.luminance.reserve((groups.size() - i) * reduced->luminance.image.size().PixelCount());
    }
    AddToStack(*reduced, drive, calibration, levels);
    levels.reference = {drive, *std::move(reduced), figures};
  }
  if (readings.empty()) return NoUsableLevel(levels.warnings);
  if (beyond > 0) {
    levels.warnings.push_back(absl::StrFormat(
        "%d of %d levels were shown beyond the readings of the drift, which is extrapolated to "
        "them "
        "and uncertain there; show the reference patch before the first and after the last level",
        beyond, groups.size()));
  }
  levels.warnings.insert(levels.warnings.begin(), drift.warnings.begin(), drift.warnings.end());
  const optics::LuminanceImage& brightest = levels.reference.reduced.luminance;
  EYEBOX_ASSIGN_OR_RETURN(levels.series,
                          MakeLevelSeries(readings, scale_relative_sigma, brightest.image.unit,
                                          "full field, image centre"));
  return levels;
}

}  // namespace eyebox::service
