// Inverse: takes the scattered light out of an image, and says below which luminance the result
// cannot be trusted.
#ifndef EYEBOX_OPTICS_SCATTER_CORRECT_SCATTER_H_
#define EYEBOX_OPTICS_SCATTER_CORRECT_SCATTER_H_

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/scatter/scatter_kernel.h"
#include "optics/scatter/torus.h"
#include "optics/scatter/wide_glare.h"

namespace eyebox::optics {

struct CorrectionOptions {
  // The result keeps the resolution of the core: light is moved back from tail and pedestal only,
  // which hardly amplifies noise. Otherwise the core is deconvolved too, as far as noise allows.
  bool keep_core = true;
  // Standard uncertainty of the energy in tail and pedestal over that energy, from the fit of w.
  double glare_relative_sigma = 0;
  // The floor is the luminance of which `floor_sigmas` standard uncertainties are this share.
  double floor_tolerance = 0.05;
  double floor_sigmas = 2;

  // Errors: InvalidArgument naming the field (tolerance or sigmas not above 0, negative sigma).
  absl::Status Validate() const;
};

struct ScatterCorrection {
  // Same unit and mask. Masked pixels stay without a value; for the others their light was taken
  // from the surroundings (see FillMasked). The variance of a pixel is right where the noise varies
  // little over the core; without the core, neighbours within it are no longer independent.
  LuminanceImage luminance;
  // Unit of the image, [height, width], NaN where masked: above it a pixel's luminance is within
  // floor_tolerance of the truth, at floor_sigmas. Counts noise, the uncertainty of the kernel
  // times the glare that was removed, all glare from masked pixels, and rounding.
  Image<float> floor;
  double regularisation = 0;     // 0 for noiseless images and where the core is kept
  double noise_gain = 1;         // variance out over variance in, for even noise
  double below_floor_share = 0;  // of the valid pixels
  double light_before = 0;       // sums over the valid pixels
  double light_after = 0;
};

// Prepared for one kernel and image size, for any number of images. With W and C the transfers of w
// and its core, a spectrum is multiplied by C / W if the core is kept: at most 1 / the core's
// share, which is also what is left of it where both vanish, so that noise stays independent from
// pixel to pixel. If the core goes too, by W / (W^2 + lambda K (1 - C^2)): a Wiener filter for
// images whose power falls as 1 / frequency^2, of which K is the discrete form 4 - 2 cos - 2 cos.
// lambda = noise variance / mean squared gradient of the image, so that noise is held down only
// where the core has lost the signal. The gain at frequency 0 is exactly 1 / sum of w: energy is
// conserved. The scene is taken as dark outside the image; what it scatters across the edge is
// allowed for. Not thread-safe: owns its work memory (16 times the pixels of the image, in bytes 64
// per pixel).
class ScatterCorrector {
 public:
  // Errors: InvalidArgument (kernel, options, pitch not above 0, empty size).
  static absl::StatusOr<ScatterCorrector> Create(const ScatterKernel& kernel, ImageSize size,
                                                 double pitch_deg,
                                                 const CorrectionOptions& options = {});

  // `reading` lies on a grid of equal steps in field angle. All masked: the same comes back.
  // Errors: InvalidArgument (another size; a valid pixel whose value is not finite or whose
  // variance is not finite and at least 0: names it).
  absl::StatusOr<ScatterCorrection> Correct(const LuminanceImage& reading);

 private:
  ScatterCorrector(const ScatterKernel& kernel, ImageSize size, double pitch_deg,
                   const CorrectionOptions& options);
  struct Wide;
  double Deconvolve(double lambda, Image<float>& light);
  Wide Spread(const MeasuredImage& reading, const Image<float>& filled, bool any_masked);
  void Finish(const Wide& wide, const MeasuredImage& reading, const Image<float>& filled,
              double brightest, ScatterCorrection& correction) const;

  ScatterKernel kernel_;
  CorrectionOptions options_;
  Torus torus_;
  Image<float> whole_;  // transfer W
  Image<float> core_;   // transfer C
  WideGlare wide_glare_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_CORRECT_SCATTER_H_
