#include "capture/camera/sim/scene.h"

#include <algorithm>

#include "capture/base/status.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/faults.h"
#include "capture/camera/sim/optics.h"

namespace eyebox::capture {
namespace {

void MultiplyBy(const Image<double>& factor, Image<double>& image) {
  for (size_t i = 0; i < image.pixels().size(); ++i) image.pixels()[i] *= factor.pixels()[i];
}

// cd/m2 as a perfect camera at the eye point would see it.
absl::StatusOr<Image<double>> LuminanceOf(const SimParameters& parameters,
                                          const CaptureSpec& spec) {
  const ImageSize size = parameters.sensor.size;
  if (spec.kind == FrameKind::kDark) return Image<double>(size, 0.0);
  if (spec.kind == FrameKind::kFlat) {
    if (!spec.luminance_cd_m2 || !(*spec.luminance_cd_m2 >= 0)) {
      return BadInput("luminance_cd_m2 of a flat", "is missing or negative",
                      "give the luminance of the reference that the flat shows");
    }
    return Image<double>(size, *spec.luminance_cd_m2);
  }
  EYEBOX_ASSIGN_OR_RETURN(
      Image<double> luminance,
      DrawStimulus(parameters.display, parameters.geometry, size, spec.stimulus));
  MultiplyBy(Nonuniformity(parameters.nonuniformity, size), luminance);
  return luminance;
}

}  // namespace

absl::StatusOr<Image<double>> SceneRate(const SimParameters& parameters,
                                        const FixedPattern& pattern, const CaptureSpec& spec) {
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> luminance, LuminanceOf(parameters, spec));
  EYEBOX_ASSIGN_OR_RETURN(Image<double> rate, Scatter(luminance, parameters.scatter));
  if (spec.kind == FrameKind::kLight && parameters.faults.display_pixel_px > 0) {
    MultiplyBy(DisplayGrid(parameters.faults, parameters.sensor.size), rate);
  }
  if (parameters.vignetting) {
    MultiplyBy(Vignetting(parameters.geometry, parameters.sensor.size), rate);
  }
  MultiplyBy(pattern.response, rate);
  for (double& value : rate.pixels()) {
    // The Fourier transform leaves rounding errors of either sign where there is no light.
    value = std::max(value * parameters.sensor.responsivity_e_s_per_cd_m2, 0.0);
  }
  return rate;
}

}  // namespace eyebox::capture
