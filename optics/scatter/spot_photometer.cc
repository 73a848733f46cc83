#include "optics/scatter/spot_photometer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/kernel_grid.h"
#include "optics/scatter/spread_light.h"

namespace eyebox::optics {
namespace {

absl::Status CheckDisk(const DiskScene& scene) {
  if (!(scene.diameter_deg >= 0 && scene.field_radius_deg > 0)) {
    return BadInput("disk scene",
                    absl::StrCat("diameter ", scene.diameter_deg, " deg, field radius ",
                                 scene.field_radius_deg, " deg"),
                    "give a diameter of at least 0 and a radius above 0");
  }
  if (!std::isfinite(scene.disk_luminance) || !std::isfinite(scene.surround_luminance)) {
    return BadInput("disk scene", "a luminance is not finite", "give finite luminances");
  }
  return absl::OkStatus();
}

absl::Status CheckAim(ImageSize size, int x_px, int y_px) {
  if (x_px >= 0 && x_px < size.width_px && y_px >= 0 && y_px < size.height_px) {
    return absl::OkStatus();
  }
  return BadInput("aim", absl::StrCat("pixel (", x_px, ", ", y_px, ")"), "aim within the scene");
}

// Sum of a radial weight, sampled around the aim, times the scene.
absl::StatusOr<double> WeighScene(const ScatterKernel& kernel, const Image<float>& scene,
                                  double pitch_deg, int x_px, int y_px) {
  EYEBOX_RETURN_IF_ERROR(kernel.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckGrid(scene.size(), pitch_deg));
  EYEBOX_RETURN_IF_ERROR(CheckAim(scene.size(), x_px, y_px));
  const auto [width, height] = scene.size();
  const Image<float> weights =
      SampleKernel(RadialWeight(kernel), pitch_deg,
                   {std::max(x_px + 1, width - x_px), std::max(y_px + 1, height - y_px)});
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      sum +=
          static_cast<double>(weights.at(std::abs(x - x_px), std::abs(y - y_px))) * scene.at(x, y);
    }
  }
  if (std::isfinite(sum)) return sum;
  return BadInput("scene", "a pixel is not finite", "give a finite luminance everywhere");
}

}  // namespace

absl::StatusOr<double> ReadDisk(const SpotPhotometer& photometer, const DiskScene& scene) {
  EYEBOX_RETURN_IF_ERROR(photometer.weight.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckDisk(scene));
  const RadialWeight weight(photometer.weight);
  const double field = weight.EnergyWithin(scene.field_radius_deg);
  const double disk = weight.EnergyWithin(std::min(scene.diameter_deg / 2, scene.field_radius_deg));
  return scene.disk_luminance * disk + scene.surround_luminance * (field - disk);
}

absl::StatusOr<double> ReadScene(const SpotPhotometer& photometer, const Image<float>& scene,
                                 double pitch_deg, int x_px, int y_px) {
  return WeighScene(photometer.weight, scene, pitch_deg, x_px, y_px);
}

absl::StatusOr<double> ReadSceneIdeally(const SpotPhotometer& photometer, const Image<float>& scene,
                                        double pitch_deg, int x_px, int y_px) {
  ScatterKernel target{.core = CoreShape::kDisk,
                       .core_radius_deg = photometer.target_diameter_deg / 2};
  EYEBOX_RETURN_IF_ERROR(target.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckGrid(scene.size(), pitch_deg));
  const int margin =
      std::min({x_px, y_px, scene.size().width_px - 1 - x_px, scene.size().height_px - 1 - y_px});
  if ((margin + 0.5) * pitch_deg < target.core_radius_deg) {
    return BadInput("aim", absl::StrCat("pixel (", x_px, ", ", y_px, ")"),
                    "aim so that the whole target lies within the scene");
  }
  return WeighScene(target, scene, pitch_deg, x_px, y_px);
}

}  // namespace eyebox::optics
