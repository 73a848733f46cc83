// The drift of the display while it was measured, from the reference patch of the recording and
// from the photodiode.
#ifndef EYEBOX_SERVICE_STEPS_DRIFT_H_
#define EYEBOX_SERVICE_STEPS_DRIFT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/photometry/drift.h"

namespace eyebox::service {

struct MeasuredDrift {
  optics::Drift drift;                // of order 0 where none was found or none was looked for
  std::vector<std::string> warnings;  // what was found, or why nothing could be
};

// Fits what the two sources of drift_sources.h saw, together where they agree within 4 sigma. Where
// they do not, the camera's alone: whatever drifts, display or camera, it is the camera's levels
// that are corrected. Captures whose light departs from that of their stimulus are named in a
// warning. A recording without either source has no drift and no warning.
// Errors: those of reading.
absl::StatusOr<MeasuredDrift> MeasureDrift(capture::RecordingReader& recording);

// Corrects what was read in `captures` to the middle of the recording; returns the relative
// standard uncertainty of that, 0 where there is no drift. What was taken beyond the readings of
// the drift by more than a tenth of their span stays as it is, and comes back empty: drift is not
// extrapolated. Errors: those of reading.
absl::StatusOr<std::optional<double>> CorrectForDriftWithin(
    capture::RecordingReader& recording, const std::vector<const capture::CaptureEntry*>& captures,
    const optics::Drift& drift, optics::LuminanceImage& luminance);

// Whether they were taken beyond the readings of the drift by more than a tenth of their span.
// Errors: those of reading.
absl::StatusOr<bool> IsBeyondDrift(capture::RecordingReader& recording,
                                   const std::vector<const capture::CaptureEntry*>& captures,
                                   const optics::Drift& drift);

// The same, however far beyond: of levels, which have references before and after them. Further
// out the uncertainty grows with that of the drift's polynomial.
absl::StatusOr<double> CorrectForDrift(capture::RecordingReader& recording,
                                       const std::vector<const capture::CaptureEntry*>& captures,
                                       const optics::Drift& drift,
                                       optics::LuminanceImage& luminance);

// CLOCK_MONOTONIC of the first frame of each capture, averaged: when a bracket was taken. It takes
// seconds, in which no display drifts. `captures` is not empty. Errors: those of reading.
absl::StatusOr<double> TimeOf(capture::RecordingReader& recording,
                              const std::vector<const capture::CaptureEntry*>& captures);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_DRIFT_H_
