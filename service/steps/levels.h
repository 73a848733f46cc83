// From the captures of a series to the luminance of every grey level, one level at a time.
#ifndef EYEBOX_SERVICE_STEPS_LEVELS_H_
#define EYEBOX_SERVICE_STEPS_LEVELS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/large_memory.h"
#include "capture/recording/reader.h"
#include "fit/activation/level_series.h"
#include "fit/budget/budget_terms.h"
#include "fit/field/common_exponent.h"
#include "optics/reduce/reduce_level.h"
#include "optics/uniformity/level_independence.h"
#include "service/steps/captures.h"
#include "service/steps/take_scatter_out.h"
#include "service/watcher.h"

namespace eyebox::service {

struct GreyLevel {
  double drive = 0;
  optics::ReducedLevel reduced;
  std::optional<optics::GlareRemovalFigures> glare;  // where scatter was taken out
};

// A side of the blocks in which levels are compared: about 24 along the longer side.
int LevelBlockPx(ImageSize size);

struct MeasuredLevels {
  fit::LevelSeries series;                 // at the reference point, see reference_disk.h
  std::vector<fit::ReadingShares> shares;  // of the variance of each of its readings
  GreyLevel reference;                     // the brightest level: g is measured there
  ImageSize size;
  std::vector<double> drives;               // [levels], ascending
  UninitialisedVector<float> luminance;     // [levels, height * width]; NaN where there is no value
  std::vector<uint8_t> valid;               // [height * width], 1 where every level has a value
  std::vector<optics::LevelBlocks> blocks;  // for the test whether g is the same at all levels
  std::vector<std::string> warnings;        // levels that were left out, and why

  fit::FieldStack Field() const { return {drives, luminance, valid}; }
};

// The series to work on: `asked`, or the main one "", or the only one there is.
// Errors: NotFound (no such series, or several and none asked for: lists them).
absl::StatusOr<std::string> ChooseSeries(const capture::RecordingReader& recording,
                                         const std::optional<std::string>& asked);

struct BracketOptions {
  double clip_sigmas = 0;       // see ClipStack(); 0: every frame counts
  bool repair_defects = false;  // see RepairDefects()
};

// One bracket. Errors: those of reading, of ClipStack and of ReduceLevel.
absl::StatusOr<optics::ReducedLevel> ReduceCaptures(capture::RecordingReader& recording,
                                                    const StimulusCaptures& group,
                                                    const optics::Calibration& calibration,
                                                    const BracketOptions& options = {});

// All grey levels. A level with no value at the reference point or over most of the field (it
// saturates even the shortest exposure) is left out with a warning. Where the reference patch of
// the recording drifted, every level is corrected for it, with a warning.
// Memory: one level, the brightest one, and four bytes per level and pixel.
// Errors: those of ReduceCaptures; FailedPrecondition (no grey level, none of them usable).
absl::StatusOr<MeasuredLevels> ReduceGreyLevels(capture::RecordingReader& recording,
                                                const std::string& series,
                                                const optics::Calibration& calibration,
                                                const Watcher& watcher,
                                                const KnownGlare& glare = {},
                                                const BracketOptions& bracket = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_LEVELS_H_
