// Readings that show how light scatters: disks of growing diameter, a small bright source seen from
// its side, black disks on a bright field.
#ifndef EYEBOX_FIT_SCATTER_GLARE_SERIES_H_
#define EYEBOX_FIT_SCATTER_GLARE_SERIES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"

namespace eyebox::fit {

enum class GlarePattern {
  kBrightDisk,  // bright on the display's black; a small one is a bright source
  kBlackDisk,   // black on the bright field
};

// How far pixels of a reading look from the disk's centre, and which share of them does.
struct OffsetShare {
  double offset_deg = 0;
  double share = 1;
};

struct GlareReading {
  GlarePattern pattern = GlarePattern::kBrightDisk;
  double diameter_deg = 0;  // 0: no disk, the plain field
  // Of the disk's centre from where the instrument looks; of several pixels a mean.
  double offset_deg = 0;
  double luminance = 0;                   // unit of the series; of a camera, the mean of its pixels
  double luminance_sigma = 0;             // standard uncertainty, without the scale's
  std::vector<OffsetShare> offsets = {};  // of its pixels, shares sum to 1; empty: all as above
  // Of an error that is the same number of these in all readings, beside luminance_sigma.
  double shared_sigma = 0;
};

// A ring of the display around the disk's centre, from the ring before to `outer_radius_deg`. In
// between, g is a straight line over the square of the radius.
struct FieldRing {
  double outer_radius_deg = 0;
  double relative = 1;  // mean of g over it, in any unit: all is taken relative to the centre
};

struct GlareSeries {
  std::vector<GlareReading> readings;
  double field_radius_deg = 50;  // of the display, around the disk's centre
  std::string luminance_unit;    // "cd/m2" or "relative"
  std::string source;            // a file or recording, for messages
  // How the display's own luminance varies, rings by rising radius; dark beyond the last. Empty:
  // even up to field_radius_deg.
  std::vector<FieldRing> field = {};

  // Errors: InvalidArgument naming source and reading (fewer than 4, an angle negative or not
  // finite, luminance not finite, sigma not above 0) or ring.
  absl::Status Validate() const;
  double LargestLuminance() const;
  double FieldEndDeg() const;
  // g over g in the centre; 1 of an even field.
  double FieldAt(double radius_deg) const;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_GLARE_SERIES_H_
