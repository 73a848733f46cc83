#include "fit/scatter/read_disk.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/reduce/flat_variance.h"
#include "optics/scatter/radial_profile.h"

namespace eyebox::fit {
namespace {

constexpr double kLeastOwnShare = 1e-6;  // single precision may lose the rest of a variance

absl::StatusOr<GlareReading> ReadSpot(const optics::MeasuredImage& image,
                                      const optics::Calibration& calibration, const DiskAim& aim,
                                      double radius_px) {
  double sum = 0, variance = 0, square_px = 0, pixels = 0;
  const auto [width, height] = image.size();
  for (int y = 0; y < height; ++y) {
    if (std::abs(y - aim.axis.y_px) > radius_px) continue;
    for (int x = 0; x < width; ++x) {
      const double r = std::hypot(x - aim.axis.x_px, y - aim.axis.y_px);
      if (r > radius_px || image.mask.at(x, y) != 0) continue;
      const double value = image.value.at(x, y);
      const double whole = image.variance.at(x, y);
      const double flat =
          optics::FlatVariance(value, calibration, static_cast<size_t>(y) * width + x);
      sum += value;
      variance += std::max(whole - flat, kLeastOwnShare * whole);
      square_px += r * r;
      ++pixels;
    }
  }
  if (pixels == 0) {
    return Rejected("spot on the axis", "it holds no valid pixel",
                    "record exposures that neither saturate nor vanish there, or widen the spot");
  }
  GlareReading reading;
  reading.offset_deg = std::sqrt(square_px / pixels) * aim.pitch_deg;
  reading.luminance = sum / pixels;
  reading.luminance_sigma = std::sqrt(variance) / pixels;
  return reading;
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

absl::Status AddRings(const optics::MeasuredImage& image, const DiskAim& aim, double diameter_deg,
                      const DiskReadingOptions& options, std::vector<GlareReading>& readings) {
  const std::vector<double> edges = RingEdges(image.size(), aim, diameter_deg / 2, options);
  if (edges.size() < 2) return absl::OkStatus();
  const auto rings =
      optics::MeasureRadialProfile(image, aim.axis.x_px, aim.axis.y_px, aim.pitch_deg, edges);
  if (absl::IsFailedPrecondition(rings.status())) return absl::OkStatus();  // all of it masked
  if (!rings.ok()) return rings.status();
  for (const optics::RadialReading& ring : *rings) {
    readings.push_back(
        {GlarePattern::kBrightDisk, diameter_deg, ring.tail_offset_deg, ring.value, ring.sigma});
  }
  return absl::OkStatus();
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
  EYEBOX_ASSIGN_OR_RETURN(GlareReading spot,
                          ReadSpot(image, calibration, aim, options.spot_radius_px));
  spot.pattern = pattern;
  spot.diameter_deg = diameter_deg;
  std::vector<GlareReading> readings = {spot};
  if (pattern == GlarePattern::kBrightDisk && diameter_deg > 0) {
    EYEBOX_RETURN_IF_ERROR(AddRings(image, aim, diameter_deg, options, readings));
  }
  for (GlareReading& reading : readings) {
    reading.luminance_sigma =
        std::hypot(reading.luminance_sigma, options.model_relative_sigma * reading.luminance);
  }
  return readings;
}

}  // namespace eyebox::fit
