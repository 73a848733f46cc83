// A dark of an exposure that was not recorded, from darks that were, where they prove that they lie
// on a line.
#ifndef EYEBOX_OPTICS_REDUCE_INTERPOLATE_DARK_H_
#define EYEBOX_OPTICS_REDUCE_INTERPOLATE_DARK_H_

#include <span>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/calibration.h"

namespace eyebox::optics {

// Each pixel's dark is bias + dark current times exposure (EMVA 1288 release 4.0, "dark current"),
// fitted to the darks of the setting's gain with one weight a dark, its typical variance; so the
// result is the same weighted sum of darks at every pixel, and its variance that of the sum. The
// line is proven by at least three exposures that enclose the one asked for, by the reduced
// chi-square of all pixels that are not defective, and by the mean residual of each dark, which
// must be below a tenth of a pixel's own sigma.
// Errors: FailedPrecondition (fewer than three exposures of this gain and size, the exposure lies
// outside them, the camera clips the darks, or they are not on a line: says by how much; record a
// dark of the exposure then).
absl::StatusOr<DarkFrame> InterpolateDark(std::span<const DarkFrame> darks,
                                          const Image<uint8_t>& defective, const Setting& setting);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_INTERPOLATE_DARK_H_
