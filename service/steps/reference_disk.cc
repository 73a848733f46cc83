#include "service/steps/reference_disk.h"

#include <algorithm>
#include <cmath>

#include "capture/base/status.h"
#include "optics/reduce/flat_variance.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::service {
namespace {

constexpr double kBlackSigmas = 3;

std::vector<size_t> PixelsWithAllLevels(std::span<const DiskReading> levels) {
  std::vector<size_t> pixels;
  for (size_t i = 0; i < levels[0].luminance.size(); ++i) {
    const bool everywhere = std::all_of(levels.begin(), levels.end(), [i](const auto& level) {
      return std::isfinite(level.luminance[i]);
    });
    if (everywhere) pixels.push_back(i);
  }
  return pixels;
}

double SumOver(const std::vector<size_t>& pixels, const std::vector<double>& values) {
  double sum = 0;
  for (const size_t i : pixels) sum += values[i];
  return sum;
}

// Signed: an error that all readings share.
double ScatterRelativeSigma(const DiskReading& level, const std::vector<size_t>& pixels) {
  const double luminance = SumOver(pixels, level.luminance);
  return luminance > 0 ? SumOver(pixels, level.scatter_sigma) / luminance : 0;
}

fit::LevelReading MeanOf(const DiskReading& level, const std::vector<size_t>& pixels,
                         double shared_relative_sigma) {
  const auto count = static_cast<double>(pixels.size());
  fit::LevelReading reading;
  reading.drive = level.drive;
  reading.luminance = SumOver(pixels, level.luminance) / count;
  const double apart = ScatterRelativeSigma(level, pixels) - shared_relative_sigma;
  reading.luminance_sigma =
      std::hypot(std::sqrt(SumOver(pixels, level.own_variance)) / count,
                 level.relative_sigma * reading.luminance, apart * reading.luminance);
  if (reading.luminance < 0 && reading.luminance > -kBlackSigmas * reading.luminance_sigma) {
    reading.luminance = 0;
  }
  return reading;
}

}  // namespace

std::vector<size_t> ReferenceDiskPixels(ImageSize size) {
  const optics::UniformityOptions options;
  const double centre_x = 0.5 * (size.width_px - 1);
  const double centre_y = 0.5 * (size.height_px - 1);
  const double radius =
      std::max(options.reference_radius_fraction * std::min(size.width_px, size.height_px), 1.0);
  std::vector<size_t> pixels;
  const auto last = [&](double centre, int extent) {
    return std::min(static_cast<int>(centre + radius), extent - 1);
  };
  for (int y = static_cast<int>(std::max(centre_y - radius, 0.0));
       y <= last(centre_y, size.height_px); ++y) {
    for (int x = static_cast<int>(std::max(centre_x - radius, 0.0));
         x <= last(centre_x, size.width_px); ++x) {
      if (std::hypot(x - centre_x, y - centre_y) > radius) continue;
      pixels.push_back(static_cast<size_t>(y) * size.width_px + x);
    }
  }
  return pixels;
}

DiskReading ReadReferenceDisk(const optics::LuminanceImage& image,
                              const optics::Calibration& calibration, double drive) {
  DiskReading level;
  level.drive = drive;
  for (const size_t i : ReferenceDiskPixels(image.image.size())) {
    const double luminance = image.image.value.pixels()[i];  // NaN where masked
    const double variance = image.image.variance.pixels()[i];
    const double flat = optics::FlatVariance(luminance, calibration, i);
    level.luminance.push_back(luminance);
    // Single precision may lose the difference where the flat is nearly all of the variance.
    level.own_variance.push_back(std::max(variance - flat, 1e-6 * variance));
    level.flat_variance.push_back(flat);
    level.scatter_sigma.push_back(image.ScatterSigma(i));
  }
  return level;
}

absl::StatusOr<fit::LevelSeries> MakeLevelSeries(std::span<const DiskReading> levels,
                                                 double scale_relative_sigma,
                                                 const std::string& unit,
                                                 const std::string& source) {
  const std::vector<size_t> pixels =
      levels.empty() ? std::vector<size_t>() : PixelsWithAllLevels(levels);
  if (pixels.empty()) {
    return Rejected(source, "no pixel at the image centre has a value at every level",
                    "record exposures that neither saturate nor vanish there");
  }
  fit::LevelSeries series;
  const DiskReading& brightest = levels.back();
  const double scatter_relative_sigma = ScatterRelativeSigma(brightest, pixels);
  for (const DiskReading& level : levels) {
    series.readings.push_back(MeanOf(level, pixels, scatter_relative_sigma));
  }
  const double flat_relative_sigma =
      std::sqrt(SumOver(pixels, brightest.flat_variance)) / SumOver(pixels, brightest.luminance);
  series.scale_relative_sigma =
      std::hypot(scale_relative_sigma, flat_relative_sigma, scatter_relative_sigma);
  series.scatter_relative_sigma = std::abs(scatter_relative_sigma);
  series.flat_relative_sigma = flat_relative_sigma;
  series.luminance_unit = unit;
  series.source = source;
  return series;
}

}  // namespace eyebox::service
