// Takes a known instrument's scatter out of an image, whatever shines beside it.
#ifndef EYEBOX_OPTICS_SCATTER_REMOVE_GLARE_H_
#define EYEBOX_OPTICS_SCATTER_REMOVE_GLARE_H_

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/scatter/known_glare.h"

namespace eyebox::optics {

struct GlareRemoval {
  // Its variance counts noise, and glare from light that had to be guessed, which is alike in
  // neighbouring pixels. The uncertainty of the kernel times the glare that was removed stands in
  // scatter_sigma.
  LuminanceImage luminance;
  Image<float> floor;  // see ScatterCorrection
  GlareRemovalFigures figures;
};

// Errors: InvalidArgument (kernel, pitch, sigma, an empty image).
absl::StatusOr<GlareRemoval> RemoveGlare(const LuminanceImage& reading, const KnownGlare& glare);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_REMOVE_GLARE_H_
