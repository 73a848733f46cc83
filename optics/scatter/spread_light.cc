#include "optics/scatter/spread_light.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/kernel_grid.h"
#include "optics/scatter/torus.h"

namespace eyebox::optics {

absl::Status CheckGrid(ImageSize size, double pitch_deg) {
  if (size.width_px <= 0 || size.height_px <= 0) {
    return BadInput("image", absl::StrCat(size.width_px, " x ", size.height_px, " pixels"),
                    "give an image with pixels");
  }
  if (!(pitch_deg > 0 && std::isfinite(pitch_deg))) {
    return BadInput("pitch_deg", absl::StrCat(pitch_deg), "give degrees per pixel above 0");
  }
  return absl::OkStatus();
}

absl::StatusOr<Image<float>> SpreadLight(const Image<float>& scene, double pitch_deg,
                                         const ScatterKernel& kernel) {
  EYEBOX_RETURN_IF_ERROR(kernel.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckGrid(scene.size(), pitch_deg));
  for (int y = 0; y < scene.size().height_px; ++y) {
    for (int x = 0; x < scene.size().width_px; ++x) {
      if (std::isfinite(scene.at(x, y))) continue;
      return BadInput(absl::StrCat("scene, pixel (", x, ", ", y, ")"), absl::StrCat(scene.at(x, y)),
                      "give a finite luminance everywhere");
    }
  }
  Torus torus(scene.size());
  const Image<float> transfer =
      torus.Transfer(SampleKernel(RadialWeight(kernel), pitch_deg, scene.size()));
  Image<float> spread = scene;
  torus.Filter(spread, transfer);
  return spread;
}

}  // namespace eyebox::optics
