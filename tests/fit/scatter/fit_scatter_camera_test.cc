// From camera frames to w and back: frames of disks are spread on a pixel grid, w is fitted to what
// they show, and a checkerboard through the same lens is corrected with the fit.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fit/scatter/read_disk.h"
#include "optics/scatter/contrast.h"
#include "optics/scatter/correct_scatter.h"
#include "optics/scatter/spread_light.h"
#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

using optics::LuminanceImage;
using optics::ScatterKernel;

constexpr double kPitchDeg = 0.05;
constexpr int kSize = 401;
constexpr int kMiddle = kSize / 2;
constexpr double kFieldRadiusDeg = 9.9;
constexpr double kBright = 100;
const ScatterKernel kLens{.core_radius_deg = 0.1,
                          .tail_share = 0.06,
                          .tail_radius_deg = 0.8,
                          .tail_exponent = 2.7,
                          .reach_deg = 30};

// Share of a pixel that a disk in the middle covers.
double Covered(int x, int y, double radius_deg) {
  constexpr int kSamples = 9;
  if (std::abs(std::hypot(x - kMiddle, y - kMiddle) * kPitchDeg - radius_deg) > kPitchDeg) {
    return std::hypot(x - kMiddle, y - kMiddle) * kPitchDeg < radius_deg ? 1 : 0;
  }
  int inside = 0;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const double u = x - kMiddle + (i + 0.5) / kSamples - 0.5;
      const double v = y - kMiddle + (j + 0.5) / kSamples - 0.5;
      inside += std::hypot(u, v) * kPitchDeg < radius_deg ? 1 : 0;
    }
  }
  return static_cast<double>(inside) / (kSamples * kSamples);
}

LuminanceImage Photograph(const Image<float>& scene, uint64_t seed) {
  const auto seen = optics::SpreadLight(scene, kPitchDeg, kLens);
  EXPECT_TRUE(seen.ok()) << seen.status();
  RandomStream random({seed});
  LuminanceImage frame;
  frame.image = optics::MakeMeasuredImage(scene.size(), "cd/m2");
  for (size_t i = 0; i < scene.pixels().size(); ++i) {
    const double light = seen->pixels()[i];
    const double variance = 1e-6 + 1e-5 * std::max(light, 0.0);
    frame.image.value.pixels()[i] =
        static_cast<float>(light + std::sqrt(variance) * Gaussian(random));
    frame.image.variance.pixels()[i] = static_cast<float>(variance);
  }
  return frame;
}

LuminanceImage PhotographDisk(GlarePattern pattern, double diameter, uint64_t seed) {
  Image<float> scene({kSize, kSize});
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double disk = Covered(x, y, diameter / 2);
      const double field = Covered(x, y, kFieldRadiusDeg);
      const double bright = pattern == GlarePattern::kBrightDisk ? disk : field - disk;
      scene.at(x, y) = static_cast<float>(kBright * bright);
    }
  }
  return Photograph(scene, seed);
}

GlareSeries MeasureSeries() {
  GlareSeries series{{}, kFieldRadiusDeg, "cd/m2", "camera"};
  const DiskAim aim = {{kMiddle, kMiddle}, kPitchDeg};
  // The scene here is even over each pixel, which the model of round disks does not know.
  const DiskReadingOptions options{.model_relative_sigma = 0.0005};
  uint64_t seed = 1;
  for (const auto& [pattern, diameters] :
       {std::pair{GlarePattern::kBrightDisk,
                  std::vector<double>{0.2, 0.35, 0.6, 1, 2, 4, 8, 14, 19.8}},
        {GlarePattern::kBlackDisk, {1, 2, 4, 8}}}) {
    for (const double diameter : diameters) {
      const LuminanceImage frame = PhotographDisk(pattern, diameter, seed++);
      const auto readings = ReadDisk(frame.image, {}, aim, pattern, diameter, options);
      EXPECT_TRUE(readings.ok()) << readings.status();
      series.readings.insert(series.readings.end(), readings->begin(), readings->end());
    }
  }
  return series;
}

TEST(FitScatterCameraTest, FramesGiveTheKernelThatCorrectsThem) {
  ScatterFitOptions options;
  options.reach_deg = kLens.reach_deg;
  options.background_luminance = 0;
  const auto fit = FitScatter(MeasureSeries(), options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_NEAR(fit->kernel.tail_share, kLens.tail_share, 3 * fit->parameters[1].sigma);
  // The pixels of the scene, each even over its area, widen the core.
  EXPECT_NEAR(fit->kernel.core_radius_deg,
              std::hypot(kLens.core_radius_deg, kPitchDeg / std::sqrt(12)),
              3 * fit->parameters[0].sigma);
  EXPECT_LT(fit->parameters[0].sigma, 0.002);
  EXPECT_LT(fit->parameters[1].sigma, 0.1 * kLens.tail_share);

  const optics::Checkerboard board{{-0.5, -0.5}, kSize / 5.0, 5, 5};
  Image<float> scene = optics::DrawCheckerboard({kSize, kSize}, board);
  for (float& value : scene.pixels()) value = 0.5F + value * 99.5F;
  const LuminanceImage seen = Photograph(scene, 99);
  auto corrector = optics::ScatterCorrector::Create(
      fit->kernel, scene.size(), kPitchDeg, {.glare_relative_sigma = fit->glare_relative_sigma});
  ASSERT_TRUE(corrector.ok());
  const auto corrected = corrector->Correct(seen);
  ASSERT_TRUE(corrected.ok());
  const auto before = optics::CheckerboardContrast(seen, board, std::nullopt);
  const auto after = optics::CheckerboardContrast(corrected->luminance, board, std::nullopt);
  ASSERT_TRUE(before.ok() && after.ok());
  EXPECT_GT(before->dark, 1.5);  // of 0.5
  // The floor is where 2 sigma are 5 %: what is left of the error must fit the stated uncertainty.
  const double sigma = fit->glare_relative_sigma * (before->dark - after->dark);
  EXPECT_NEAR(after->dark, 0.5, 3 * sigma);
  EXPECT_LT(sigma, 0.1);
}

}  // namespace
}  // namespace eyebox::fit
