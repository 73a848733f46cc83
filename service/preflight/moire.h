// Whether the pixels of the camera beat with those of the display.
#ifndef EYEBOX_SERVICE_PREFLIGHT_MOIRE_H_
#define EYEBOX_SERVICE_PREFLIGHT_MOIRE_H_

#include <optional>

#include "capture/base/image.h"
#include "service/preflight/check.h"

namespace eyebox::service {

struct MoireOptions {
  double false_alarm_probability = 1e-4;  // of the whole check on white noise
  // Below so many cycles per side lies the shape of the field itself.
  double least_cycles = 6;
  int largest_side_px = 384;  // of the middle of the image that is looked at
  // Camera pixels per display pixel, where known: the period of the beat follows from it.
  std::optional<double> camera_px_per_display_px = {};
};

// `field` is the mean of some frames of a full field, dark subtracted, DN, [height, width]; of a
// mosaic, one colour. The texture left by a smooth fit is transformed, and the largest power in
// each of some groups of frequencies is held against the others there (Fisher's test): both axes by
// themselves, since columns and rows of a sensor differ, the rest in rings.
// The figure that decides is the false-alarm probability of the strongest peak. Figures:
// moire_amplitude (relative), moire_period (px), and camera_px_per_display_px with
// expected_period_x where the ratio is given.
// Skipped where the field is smaller than 16 px or has no light everywhere.
Check CheckMoire(const Image<double>& field, const MoireOptions& options = {});

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_MOIRE_H_
