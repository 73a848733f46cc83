// Forward: what an instrument with scatter w makes of a scene.
#ifndef EYEBOX_OPTICS_SCATTER_SPREAD_LIGHT_H_
#define EYEBOX_OPTICS_SCATTER_SPREAD_LIGHT_H_

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

// w * scene on a grid of field angles with equal steps `pitch_deg`; nothing shines outside the
// scene. Sum over the result + what leaves the grid = sum over the scene. float32: errors about
// 1e-6 of the brightest pixel.
// Errors: InvalidArgument (kernel, pitch not above 0, empty scene, a pixel that is not finite).
absl::StatusOr<Image<float>> SpreadLight(const Image<float>& scene, double pitch_deg,
                                         const ScatterKernel& kernel);

// InvalidArgument unless `pitch_deg` is above 0 and `size` is not empty.
absl::Status CheckGrid(ImageSize size, double pitch_deg);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_SPREAD_LIGHT_H_
