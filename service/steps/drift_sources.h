// Who saw the light of the display drift: the camera, on the reference patch, and the photodiode,
// on whatever was shown more than once.
#ifndef EYEBOX_SERVICE_STEPS_DRIFT_SOURCES_H_
#define EYEBOX_SERVICE_STEPS_DRIFT_SOURCES_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/recording/reader.h"
#include "optics/photometry/drift.h"

namespace eyebox::service {

struct DriftSource {
  bool present = false;  // the recording holds it
  std::string obstacle;  // why it tells nothing; empty where it does
  std::vector<optics::DriftReading> readings;
  std::vector<const capture::CaptureEntry*> captures;  // that each reading is of
};

// Captures of role kReference: mean count of the frames above the dark of their setting, at the
// time of their first frame. Errors: those of reading.
absl::StatusOr<DriftSource> CameraReferences(capture::RecordingReader& recording);

// Every light capture of a known stimulus, one series for each stimulus: the photodiode's counts
// above what it reads during the darks. The sigma of a reading is learnt from how readings of one
// stimulus scatter about the drift that fits best. Readings below a tenth of the brightest are left
// out, as are clipped ones. Where the first such capture has none, no other is looked at.
// Errors: those of reading.
absl::StatusOr<DriftSource> PhotodiodeReadings(capture::RecordingReader& recording);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_DRIFT_SOURCES_H_
