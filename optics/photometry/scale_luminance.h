// From a rate to cd/m2.
#ifndef EYEBOX_OPTICS_PHOTOMETRY_SCALE_LUMINANCE_H_
#define EYEBOX_OPTICS_PHOTOMETRY_SCALE_LUMINANCE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"

namespace eyebox::optics {

// Multiplies by the known luminance that a value of 1 stands for (the luminance of the flat when
// `image` is a ratio to it; cd/m2 per DN/s when it is a rate). Without one the result is relative.
// Errors: InvalidArgument (luminance not above 0, or a relative sigma outside 0 to 1).
absl::StatusOr<LuminanceImage> ScaleLuminance(MeasuredImage image, bool flat_corrected,
                                              const std::optional<KnownLuminance>& per_unit);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_PHOTOMETRY_SCALE_LUMINANCE_H_
