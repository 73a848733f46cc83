// Which captures of a recording belong together.
#ifndef EYEBOX_SERVICE_STEPS_CAPTURES_H_
#define EYEBOX_SERVICE_STEPS_CAPTURES_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/reduce/frame_stacker.h"

namespace eyebox::service {

// All captures of one stimulus: an exposure bracket.
struct StimulusCaptures {
  std::string series;
  Stimulus stimulus;
  std::vector<const capture::CaptureEntry*> captures;
};

// Suspect captures are left out.
std::vector<const capture::CaptureEntry*> CapturesOfKind(const capture::RecordingReader& recording,
                                                         FrameKind kind);

// The light captures of a series by stimulus, in the order in which each was first taken.
// Errors: NotFound (no such series: lists those there are).
absl::StatusOr<std::vector<StimulusCaptures>> LightCaptures(
    const capture::RecordingReader& recording, const std::string& series);

// Grey full fields only, by rising drive value.
// Errors: FailedPrecondition (none: says what to record).
absl::StatusOr<std::vector<StimulusCaptures>> GreyLevels(const capture::RecordingReader& recording,
                                                         const std::string& series);

// Of the first whole frame of a capture. Errors: those of reading; FailedPrecondition (it holds
// none).
absl::StatusOr<FrameMetadata> FirstMetadata(capture::RecordingReader& recording,
                                            const capture::CaptureEntry& entry);

// One stack per exposure and gain; captures of the same setting are averaged together.
// Errors: those of reading.
absl::StatusOr<std::vector<optics::Stack>> StackCaptures(
    capture::RecordingReader& recording, const std::vector<const capture::CaptureEntry*>& captures,
    double saturation_margin = optics::SensorRange{}.saturation_margin, bool keep_extremes = false);

// Distance of neighbours of one colour: 1 of a grey sensor, 2 of a Bayer mosaic. 2 also where the
// recording does not tell (imported frames): right for both, if less sharp for a grey one.
int ColourPeriodPx(const capture::RecordingHeader& header);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_CAPTURES_H_
