#include "service/steps/reference_disk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace eyebox::service {
namespace {

constexpr ImageSize kSize{.width_px = 20, .height_px = 10};  // the disk has a radius of 1 px

optics::LuminanceImage Uniform(float luminance, float own_variance, float flat_relative_variance) {
  optics::LuminanceImage image;
  image.image = optics::MakeMeasuredImage(kSize, "cd/m2");
  for (float& value : image.image.value.pixels()) value = luminance;
  const float variance = own_variance + luminance * luminance * flat_relative_variance;
  for (float& value : image.image.variance.pixels()) value = variance;
  return image;
}

void Invalidate(optics::LuminanceImage& image, size_t pixel) {
  image.image.mask.pixels()[pixel] = optics::kSaturated;
  optics::BlankMaskedPixels(image.image);
}

optics::Calibration WithFlat(float response, float relative_variance) {
  optics::Calibration calibration;
  calibration.flat = optics::FlatField{optics::MakeMeasuredImage(kSize, "DN/s"), std::nullopt};
  for (float& value : calibration.flat->response.value.pixels()) value = response;
  for (float& value : calibration.flat->response.variance.pixels()) {
    value = response * response * relative_variance;
  }
  return calibration;
}

TEST(ReferenceDisk, IsCentredOnTheImage) {
  const std::vector<size_t> pixels = ReferenceDiskPixels(kSize);
  ASSERT_EQ(pixels.size(), 4U);  // the centre lies between four pixels
  EXPECT_EQ(pixels[0], 4U * 20 + 9);
  EXPECT_EQ(pixels[3], 5U * 20 + 10);
  EXPECT_EQ(ReferenceDiskPixels({.width_px = 1, .height_px = 1}).size(), 1U);
}

TEST(ReferenceDisk, TheFlatsErrorGoesIntoTheScaleNotIntoTheReadings) {
  const optics::Calibration calibration = WithFlat(500, 0.01F);
  const std::vector<DiskReading> levels = {
      ReadReferenceDisk(Uniform(1, 0.04F, 0.01F), calibration, 0),
      ReadReferenceDisk(Uniform(60, 0.36F, 0.01F), calibration, 1)};
  const auto series = MakeLevelSeries(levels, 0.02, "cd/m2", "test");
  ASSERT_TRUE(series.ok()) << series.status();
  EXPECT_NEAR(series->readings[0].luminance_sigma, 0.2 / 2, 1e-5);  // of 4 pixels
  EXPECT_NEAR(series->readings[1].luminance_sigma, 0.6 / 2, 1e-4);
  EXPECT_NEAR(series->scale_relative_sigma, std::hypot(0.02, 0.1 / 2), 1e-6);
}

TEST(ReferenceDisk, WithoutAFlatAllVarianceIsTheLevelsOwn) {
  const std::vector<DiskReading> levels = {ReadReferenceDisk(Uniform(60, 0.36F, 0), {}, 1)};
  const auto series = MakeLevelSeries(levels, 0, "relative", "test");
  ASSERT_TRUE(series.ok()) << series.status();
  EXPECT_NEAR(series->readings[0].luminance_sigma, 0.3, 1e-6);
  EXPECT_EQ(series->scale_relative_sigma, 0);
  EXPECT_EQ(series->luminance_unit, "relative");
}

TEST(ReferenceDisk, APixelThatOneLevelLacksCountsAtNone) {
  optics::LuminanceImage dim = Uniform(1, 0.01F, 0);
  dim.image.value.pixels()[4 * 20 + 9] = 101;
  optics::LuminanceImage white = Uniform(60, 0.01F, 0);
  Invalidate(white, 4 * 20 + 9);
  const std::vector<DiskReading> levels = {ReadReferenceDisk(dim, {}, 0),
                                           ReadReferenceDisk(white, {}, 1)};
  const auto series = MakeLevelSeries(levels, 0, "cd/m2", "test");
  ASSERT_TRUE(series.ok()) << series.status();
  EXPECT_FLOAT_EQ(static_cast<float>(series->readings[0].luminance), 1);
}

TEST(ReferenceDisk, ABlackDisplayMayReadSlightlyBelowZero) {
  const auto black_of = [](float luminance) {
    const std::vector<DiskReading> levels = {
        ReadReferenceDisk(Uniform(luminance, 0.04F, 0), {}, 0)};
    return MakeLevelSeries(levels, 0, "cd/m2", "test")->readings[0].luminance;
  };
  EXPECT_EQ(black_of(-0.2F), 0);             // 2 sigma
  EXPECT_NEAR(black_of(-0.5F), -0.5, 1e-6);  // 5 sigma is a fault, not noise
}

TEST(ReferenceDisk, NoCommonPixelIsRejected) {
  optics::LuminanceImage image = Uniform(1, 0.01F, 0);
  for (const size_t pixel : ReferenceDiskPixels(kSize)) Invalidate(image, pixel);
  const std::vector<DiskReading> levels = {ReadReferenceDisk(image, {}, 0)};
  EXPECT_TRUE(absl::IsFailedPrecondition(MakeLevelSeries(levels, 0, "cd/m2", "x").status()));
  EXPECT_TRUE(absl::IsFailedPrecondition(MakeLevelSeries({}, 0, "cd/m2", "x").status()));
}

}  // namespace
}  // namespace eyebox::service
