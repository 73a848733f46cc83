#include "optics/scatter/radial_profile.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/spread_light.h"

namespace eyebox::optics {
namespace {

struct RingSums {
  double value = 0;
  double variance = 0;
  double square_deg = 0;
  double inverse_square = 0;  // 1/deg2
  size_t pixels = 0;
};

absl::Status CheckEdges(std::span<const double> edges_deg) {
  bool ascending = edges_deg.size() >= 2 && edges_deg.front() >= 0;
  for (size_t k = 1; k < edges_deg.size(); ++k) {
    ascending = ascending && edges_deg[k] > edges_deg[k - 1];
  }
  if (ascending) return absl::OkStatus();
  return BadInput("edges_deg", absl::StrCat(edges_deg.size(), " edges"),
                  "give at least two, ascending from 0 or more");
}

}  // namespace

absl::StatusOr<std::vector<RadialReading>> MeasureRadialProfile(const MeasuredImage& image,
                                                                double x_px, double y_px,
                                                                double pitch_deg,
                                                                std::span<const double> edges_deg) {
  EYEBOX_RETURN_IF_ERROR(CheckGrid(image.size(), pitch_deg));
  EYEBOX_RETURN_IF_ERROR(CheckEdges(edges_deg));
  std::vector<RingSums> rings(edges_deg.size() - 1);
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      if (image.mask.at(x, y) != 0) continue;
      const double radius = std::hypot(x - x_px, y - y_px) * pitch_deg;
      const auto next = std::ranges::upper_bound(edges_deg, radius);
      if (next == edges_deg.begin() || next == edges_deg.end()) continue;
      RingSums& ring = rings[next - edges_deg.begin() - 1];
      ring.value += image.value.at(x, y);
      ring.variance += image.variance.at(x, y);
      ring.square_deg += radius * radius;
      ring.inverse_square += 1 / (radius * radius);
      ++ring.pixels;
    }
  }
  std::vector<RadialReading> readings;
  for (const RingSums& ring : rings) {
    if (ring.pixels == 0) continue;
    const auto count = static_cast<double>(ring.pixels);
    readings.push_back({std::sqrt(ring.square_deg / count), std::sqrt(count / ring.inverse_square),
                        ring.value / count, std::sqrt(ring.variance) / count, ring.pixels});
  }
  if (!readings.empty()) return readings;
  return Rejected("radial profile", absl::StrCat("no valid pixel around (", x_px, ", ", y_px, ")"),
                  "look at the mask and the rings' edges");
}

}  // namespace eyebox::optics
