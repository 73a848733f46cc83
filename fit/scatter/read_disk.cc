#include "fit/scatter/read_disk.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/scatter/pixel_reading.h"
#include "optics/reduce/flat_variance.h"
#include "optics/scatter/spread_light.h"

namespace eyebox::fit {
namespace {

constexpr double kSpotStepPx = 0.1;
constexpr double kRingStep = 0.03;       // of the distance from the disk's edge
constexpr double kLeastOwnShare = 1e-6;  // single precision may lose the rest of a variance

absl::StatusOr<GlareReading> ReadSpot(const optics::MeasuredImage& image,
                                      const optics::Calibration& calibration, const DiskAim& aim,
                                      double radius_px) {
  PixelReading spot(kSpotStepPx);
  double flat_variance = 0, pixels = 0;
  const auto [width, height] = image.size();
  for (int y = 0; y < height; ++y) {
    const double down = y - aim.axis.y_px;
    if (std::abs(down) > radius_px) continue;
    for (int x = 0; x < width; ++x) {
      const double across = x - aim.axis.x_px;
      if (std::hypot(across, down) > radius_px || image.mask.at(x, y) != 0) continue;
      const double value = image.value.at(x, y);
      const double whole = image.variance.at(x, y);
      const double flat =
          optics::FlatVariance(value, calibration, static_cast<size_t>(y) * width + x);
      spot.Add(across, down, value, std::max(whole - flat, kLeastOwnShare * whole));
      flat_variance += flat;
      ++pixels;
    }
  }
  if (!spot.empty()) {
    GlareReading reading = spot.Finish(aim.pitch_deg);
    reading.shared_sigma = std::sqrt(flat_variance) / pixels;
    return reading;
  }
  return Rejected("spot on the axis", "it holds no valid pixel",
                  "record exposures that neither saturate nor vanish there, or widen the spot");
}

// From outside the disk to the nearest side of the image.
std::vector<double> RingEdges(ImageSize size, const DiskAim& aim, double disk_radius_deg,
                              const DiskReadingOptions& options) {
  const double side_px = std::min({aim.axis.x_px, aim.axis.y_px, size.width_px - 1 - aim.axis.x_px,
                                   size.height_px - 1 - aim.axis.y_px});
  const double last = side_px * aim.pitch_deg;
  std::vector<double> edges;
  for (double edge = disk_radius_deg + options.ring_guard_px * aim.pitch_deg; edge <= last;
       edge = std::max(edge * options.ring_ratio, edge + aim.pitch_deg)) {
    edges.push_back(edge);
  }
  return edges;
}

std::vector<GlareReading> ReadRings(const optics::MeasuredImage& image, const DiskAim& aim,
                                    double diameter_deg, const DiskReadingOptions& options) {
  const std::vector<double> edges = RingEdges(image.size(), aim, diameter_deg / 2, options);
  if (edges.size() < 2) return {};
  std::vector<PixelReading> rings;
  for (size_t k = 0; k + 1 < edges.size(); ++k) {
    // Light falls off the faster the nearer the disk.
    rings.emplace_back(kRingStep * (edges[k] - diameter_deg / 2) / aim.pitch_deg);
  }
  const auto [width, height] = image.size();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (image.mask.at(x, y) != 0) continue;
      const double across = x - aim.axis.x_px;
      const double down = y - aim.axis.y_px;
      const auto next = std::ranges::upper_bound(edges, std::hypot(across, down) * aim.pitch_deg);
      if (next == edges.begin() || next == edges.end()) continue;
      rings[next - edges.begin() - 1].Add(across, down, image.value.at(x, y),
                                          image.variance.at(x, y));
    }
  }
  std::vector<GlareReading> readings;
  for (const PixelReading& ring : rings) {
    if (!ring.empty()) readings.push_back(ring.Finish(aim.pitch_deg));
  }
  return readings;
}

}  // namespace

absl::Status DiskReadingOptions::Validate() const {
  const auto check = [](std::string_view field, double value, double above) {
    if (value > above && std::isfinite(value)) return absl::OkStatus();
    return BadInput(field, absl::StrCat("is ", value), absl::StrCat("give more than ", above));
  };
  EYEBOX_RETURN_IF_ERROR(check("spot_radius_px", spot_radius_px, 0));
  EYEBOX_RETURN_IF_ERROR(check("ring_ratio", ring_ratio, 1));
  EYEBOX_RETURN_IF_ERROR(check("ring_guard_px", ring_guard_px, 0));
  if (model_relative_sigma >= 0 && model_relative_sigma < 1) return absl::OkStatus();
  return BadInput("model_relative_sigma", absl::StrCat("is ", model_relative_sigma),
                  "give 0 or more, below 1");
}

absl::StatusOr<std::vector<GlareReading>> ReadDisk(const optics::MeasuredImage& image,
                                                   const optics::Calibration& calibration,
                                                   const DiskAim& aim, GlarePattern pattern,
                                                   double diameter_deg,
                                                   const DiskReadingOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(optics::CheckGrid(image.size(), aim.pitch_deg));
  EYEBOX_ASSIGN_OR_RETURN(GlareReading spot,
                          ReadSpot(image, calibration, aim, options.spot_radius_px));
  std::vector<GlareReading> readings = {std::move(spot)};
  if (pattern == GlarePattern::kBrightDisk && diameter_deg > 0) {
    std::ranges::move(ReadRings(image, aim, diameter_deg, options), std::back_inserter(readings));
  }
  for (GlareReading& reading : readings) {
    reading.pattern = pattern;
    reading.diameter_deg = diameter_deg;
    reading.luminance_sigma =
        std::hypot(reading.luminance_sigma, options.model_relative_sigma * reading.luminance);
  }
  return readings;
}

}  // namespace eyebox::fit
