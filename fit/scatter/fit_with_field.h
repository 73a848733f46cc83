// w and g from one sequence of stimuli: full fields tell g, disks tell w, and each needs the other.
//
// A disk's reading is the integral of w g over it, and a full field shows g spread by w. So w is
// fitted with the g of the field as it was read, glare is taken out of the field with that w, and
// again, until w stays.
#ifndef EYEBOX_FIT_SCATTER_FIT_WITH_FIELD_H_
#define EYEBOX_FIT_SCATTER_FIT_WITH_FIELD_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/scatter/fit_scatter.h"
#include "optics/geometry/pixel_point.h"
#include "optics/photometry/luminance_image.h"
#include "optics/scatter/known_glare.h"
#include "optics/scatter/remove_glare.h"

namespace eyebox::fit {

// A full field of the drive of the disks, and where they stand in it.
struct BrightField {
  optics::LuminanceImage luminance;
  optics::PixelPoint axis;
  double pitch_deg = 0;
  double reference_radius_px = 1;  // g = 1 on average over this disk around the axis
  // kDark: the display ends within the image. Otherwise it goes on as in its outermost ring, up to
  // the field radius of the series.
  optics::Surround surround = optics::Surround::kContinued;
};

struct FieldFitOptions {
  ScatterFitOptions fit;
  int rings = 16;         // of g around the axis
  int most_rounds = 6;    // of fit and removal; 1: g as it was read
  double settled = 0.02;  // in sigmas of each kernel parameter: w stays

  // Errors: InvalidArgument naming the option.
  absl::Status Validate() const;
};

struct FieldFit {
  ScatterFit fit;
  std::vector<FieldRing> field;  // g by rings, as the last fit took it
  optics::GlareRemoval removal;  // the field without glare: g is its ratio to the axis
  int rounds = 0;
  bool settled = false;  // false: most_rounds came first
};

// Mean of the display over rings of equal width around the axis, over that around the axis itself;
// with a dark surround, of the whole ring, what lies beside the image being dark.
// Errors: InvalidArgument (fewer than 2 rings, pitch), FailedPrecondition (no valid pixel around
// the axis, its luminance not above 0).
absl::StatusOr<std::vector<FieldRing>> MeasureFieldRings(const optics::MeasuredImage& field,
                                                         const BrightField& where, int rings,
                                                         double field_radius_deg);

// `series` without field. Errors: those of FitScatter, MeasureFieldRings and RemoveGlare.
absl::StatusOr<FieldFit> FitScatterWithField(const GlareSeries& series, const BrightField& field,
                                             const FieldFitOptions& options = {});

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_FIT_WITH_FIELD_H_
