// The slowly varying part of a correction, on blocks of pixels: what the image's edge hides, noise
// that came from afar, and glare from light that had to be guessed.
#ifndef EYEBOX_OPTICS_SCATTER_WIDE_GLARE_H_
#define EYEBOX_OPTICS_SCATTER_WIDE_GLARE_H_

#include "capture/base/image.h"
#include "optics/scatter/scatter_kernel.h"
#include "optics/scatter/torus.h"

namespace eyebox::optics {

class WideGlare {
 public:
  WideGlare(const ScatterKernel& kernel, ImageSize size, double pitch_deg);

  int block_px() const { return block_px_; }

  // All arguments and results are block images (see BlockMeans).

  // Deconvolution takes the image as 0 outside, but light scattered across the edge fell there.
  // The light within the image that explains `reading` within it is sought, and what it scattered
  // outside is deconvolved: the part that plain deconvolution lacks.
  Image<float> EdgeCorrection(const Image<float>& reading);
  // Variance that a pixel takes over from others by the removal of their glare.
  Image<float> FarVariance(Image<float> variance);
  // Mean over frequencies of the squared gain that FarVariance stands for.
  double FarNoiseGain() const { return far_noise_gain_; }
  // Glare that this light throws.
  Image<float> GlareOf(Image<float> light);

 private:
  Image<float> Explain(const Image<float>& reading);

  int block_px_;
  Torus torus_;
  Torus wide_torus_;           // with a margin of half the image on all sides
  Image<float> whole_;         // transfer of w
  Image<float> wide_whole_;    // the same on wide_torus_
  Image<float> sharpness_;     // w / core on wide_torus_, between the core's share and 1
  Image<float> glare_;         // transfer of tail and pedestal
  Image<float> far_variance_;  // transfer of (tail and pedestal, per pixel, / core share)^2
  double far_noise_gain_ = 0;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_WIDE_GLARE_H_
