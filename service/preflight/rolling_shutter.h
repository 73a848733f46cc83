// Whether all rows of a frame see the same flashes: a rolling shutter before a flashing display
// shows bands.
#ifndef EYEBOX_SERVICE_PREFLIGHT_ROLLING_SHUTTER_H_
#define EYEBOX_SERVICE_PREFLIGHT_ROLLING_SHUTTER_H_

#include <span>
#include <vector>

#include "service/preflight/check.h"

namespace eyebox::service {

struct BandOptions {
  double false_alarm_probability = 1e-4;  // of the whole check on white noise
};

// Row means of frames of one steady scene, dark subtracted, DN; [frame][row]. Camera and display
// must not run in step: bands then lie elsewhere in every frame, and what stays is the scene.
// Each row is divided by its mean over the frames, and the periodogram over the rows is searched
// for a peak (Fisher's test). The figure that decides is the false-alarm probability of the
// largest. Figures: band_period (rows), band_amplitude (relative, of the fundamental). Skipped with
// fewer than 2 frames or 8 rows with light.
Check CheckRollingShutter(std::span<const std::vector<double>> row_means_dn,
                          const BandOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_ROLLING_SHUTTER_H_
