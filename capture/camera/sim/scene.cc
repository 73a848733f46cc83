#include "capture/camera/sim/scene.h"

#include <algorithm>
#include <utility>

#include "capture/base/status.h"
#include "capture/camera/sim/display.h"
#include "capture/camera/sim/faults.h"
#include "capture/camera/sim/optics.h"

namespace eyebox::capture {
namespace {

void MultiplyBy(const Image<double>& factor, Image<double>& image) {
  for (size_t i = 0; i < image.pixels().size(); ++i) image.pixels()[i] *= factor.pixels()[i];
}

// Sub-pixels across a pixel where the scene has an edge: the optics blur it before the pixels see
// it, and light within a pixel of an edge is not in its middle.
constexpr int kAcrossPixel = 4;

// The same rig with pixels so many times finer.
SimParameters Finer(const SimParameters& parameters, int times) {
  SimParameters finer = parameters;
  finer.sensor.size = {parameters.sensor.size.width_px * times,
                       parameters.sensor.size.height_px * times};
  finer.geometry.focal_length_px *= times;
  finer.geometry.principal_x_px = (parameters.geometry.principal_x_px + 0.5) * times - 0.5;
  finer.geometry.principal_y_px = (parameters.geometry.principal_y_px + 0.5) * times - 0.5;
  finer.scatter.core_sigma_px *= times;
  finer.scatter.tail_scale_px *= times;
  finer.scatter.tail_radius_px *= times;
  return finer;
}

Image<double> MeansOfBlocks(const Image<double>& fine, int times) {
  const auto [width, height] = fine.size();
  Image<double> means({width / times, height / times});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      means.at(x / times, y / times) += fine.at(x, y) / (times * times);
    }
  }
  return means;
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

// The same through the optics.
absl::StatusOr<Image<double>> ThroughOptics(const SimParameters& parameters,
                                            const CaptureSpec& spec) {
  const bool edges =
      spec.kind == FrameKind::kLight && spec.stimulus.pattern != StimulusPattern::kFullField;
  const bool spread = parameters.scatter.core_sigma_px > 0 || parameters.scatter.tail_weight > 0;
  const int times = edges && spread ? kAcrossPixel : 1;
  const SimParameters fine = Finer(parameters, times);
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> luminance, LuminanceOf(fine, spec));
  EYEBOX_ASSIGN_OR_RETURN(Image<double> seen, Scatter(luminance, fine.scatter));
  return times == 1 ? std::move(seen) : MeansOfBlocks(seen, times);
}

}  // namespace

absl::StatusOr<Image<double>> SceneRate(const SimParameters& parameters,
                                        const FixedPattern& pattern, const CaptureSpec& spec) {
  EYEBOX_ASSIGN_OR_RETURN(Image<double> rate, ThroughOptics(parameters, spec));
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
