// From the captures of disks to readings that tell how light scatters.
//
// Angles are those of the image plane, 180/pi tan(field angle): w of a camera is the same
// everywhere on its sensor, and corrections work there. Near the axis they are field angles.
#ifndef EYEBOX_SERVICE_STEPS_GLARE_READINGS_H_
#define EYEBOX_SERVICE_STEPS_GLARE_READINGS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "fit/scatter/read_disk.h"
#include "optics/reduce/calibration.h"
#include "optics/scatter/contrast.h"
#include "optics/scatter/known_glare.h"
#include "service/watcher.h"

namespace eyebox::service {

struct GlareOptions {
  fit::DiskReadingOptions reading;
  double field_radius_deg = 60;                              // of the display around the axis
  optics::Surround surround = optics::Surround::kContinued;  // of what the camera sees

  // Errors: InvalidArgument naming the option.
  absl::Status Validate() const;
};

struct BlackSpotFigure {
  double diameter_deg = 0;
  optics::GlareFigure glare;
};

struct CheckerboardFigure {
  double square_deg = 0;
  optics::ContrastFigure seen;
  // Where the instrument's scatter is known: without it, so that it is the display's own.
  std::optional<optics::ContrastFigure> corrected;
};

struct MeasuredGlare {
  fit::GlareSeries series;
  fit::DiskAim aim;
  std::optional<optics::LuminanceImage> bright_field;
  std::optional<optics::ContrastFigure> full_field_contrast;
  std::vector<BlackSpotFigure> black_spots;
  std::vector<CheckerboardFigure> checkerboards;
  std::vector<std::string> warnings;
};

// Degrees of a pixel on the axis. Errors: FailedPrecondition (the recording has no geometry).
absl::StatusOr<double> PitchDeg(const capture::RecordingHeader& header);

// The series, kGlareSeries unless given, or the only one there is. Brightest drive alone: disks of
// another are left out with a warning.
// `instrument`: scatter of the camera alone where known, for the floors of the figures and to take
// it out of checkerboards; its pitch is that of the recording.
// Errors: those of reading and ReduceLevel; NotFound (no such series); FailedPrecondition (no
// disk, no geometry, no valid pixel in the middle: says what to record).
absl::StatusOr<MeasuredGlare> MeasureGlare(capture::RecordingReader& recording,
                                           const std::optional<std::string>& series,
                                           const optics::Calibration& calibration,
                                           const GlareOptions& options,
                                           const std::optional<optics::KnownGlare>& instrument,
                                           const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_GLARE_READINGS_H_
