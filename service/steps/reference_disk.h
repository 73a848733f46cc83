// The luminance at the reference point, level by level: mean over the disk of MeasureUniformity.
//
// Which errors count where. Light, read-out and quantisation differ from level to level and make
// up the sigma of a reading. The flat is one and the same for all levels: its error multiplies
// every reading by one factor, like that of the known luminance, so that it belongs to the scale
// and leaves gamma alone; counted per reading it would inflate gamma's sigma. So it is with what is
// not known of the scattered light, of which every full field has the same share; where a level's
// share differs, the difference stays with its reading. The dark of an
// exposure is shared too, but as an offset that changes with the exposures a level uses; it stays
// in the readings' sigma, which is conservative (L0 takes up most of it) and small.
#ifndef EYEBOX_SERVICE_STEPS_REFERENCE_DISK_H_
#define EYEBOX_SERVICE_STEPS_REFERENCE_DISK_H_

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/level_series.h"
#include "optics/photometry/luminance_image.h"
#include "optics/reduce/calibration.h"

namespace eyebox::service {

// Indices (row-major) of the pixels of the disk.
std::vector<size_t> ReferenceDiskPixels(ImageSize size);

// The pixels of the disk at one level; NaN where a pixel has no value.
struct DiskReading {
  double drive = 0;
  std::vector<double> luminance;
  std::vector<double> own_variance;   // of this level alone
  std::vector<double> flat_variance;  // of the flat, common to all levels
  std::vector<double> scatter_sigma;  // of scattered light that was taken out, common to all
  double relative_sigma = 0;          // common to its pixels, not to other levels: of the drift
};

DiskReading ReadReferenceDisk(const optics::LuminanceImage& image,
                              const optics::Calibration& calibration, double drive);

// Means over the pixels that have a value at every level, so that all readings see the same flat.
// A mean below 0 by less than 3 sigma (a display that is black at drive 0) becomes 0.
// Errors: FailedPrecondition (no such pixel).
absl::StatusOr<fit::LevelSeries> MakeLevelSeries(std::span<const DiskReading> levels,
                                                 double scale_relative_sigma,
                                                 const std::string& unit,
                                                 const std::string& source);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_REFERENCE_DISK_H_
