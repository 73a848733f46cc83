// Bands and threads give the pixels that the plain steps give on the whole image.
#include "optics/reduce/reduce_band.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/order_bracket.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

// More than one band, the last one thin.
constexpr ImageSize kSize{1031, 517};
const std::vector<double> kExposures = {0.01, 0.04, 0.16};

Stack Draw(double exposure_s, double rate_dn_s, int frames, std::mt19937& random) {
  FrameStacker stacker({exposure_s, 0}, {12});
  Image<uint16_t> frame(kSize);
  for (int k = 0; k < frames; ++k) {
    size_t i = 0;
    for (uint16_t& dn : frame.pixels()) {
      const double light = rate_dn_s * exposure_s * (i++ % kSize.width_px) / kSize.width_px;
      dn = static_cast<uint16_t>(std::min(60 + light + random() % 9, 4095.0));
    }
    EXPECT_TRUE(stacker.Add({frame.pixels(), frame.size()}).ok());
  }
  return *stacker.Finish();
}

Calibration Calibrate(std::mt19937& random) {
  Calibration calibration;
  calibration.noise = {.gain_dn_per_e = 0.25, .read_variance_dn2 = 6, .bias_dn = 64};
  std::vector<Stack> darks;
  for (const double t : kExposures) darks.push_back(Draw(t, 0, 8, random));
  calibration.defects = *FindHotPixels(darks);
  for (int k = 0; k < 300; ++k) {
    calibration.defects.defective.pixels()[random() % kSize.PixelCount()] = 1;
  }
  for (const Stack& dark : darks) {
    calibration.darks.push_back(*MeasureDark(dark, calibration.noise));
  }
  return calibration;
}

struct Plain {
  MeasuredImage merged;
  ExposurePairCheck first_pair;
};

Plain StepByStep(std::span<const Stack> stacks, const Calibration& calibration,
                 const ReduceOptions& options) {
  auto bracket = *OrderBracket(stacks, calibration);
  MaskSaturation(AllRows(kSize), options, bracket);
  const Image<float> expected =
      ExpectedRate(bracket, calibration, {options.smoothing_radius, options.colour_period_px});
  std::vector<MeasuredImage> rates;
  for (const Exposure& exposure : bracket) {
    rates.push_back(*RateOf(exposure, expected, calibration, options));
  }
  return {*MergeBracket(rates),
          CompareExposures(rates[0], kExposures[0], rates[1], kExposures[1], expected)};
}

bool SameBits(const Image<float>& a, const Image<float>& b) {
  return std::equal(
      a.pixels().begin(), a.pixels().end(), b.pixels().begin(), b.pixels().end(),
      [](float x, float y) { return std::bit_cast<uint32_t>(x) == std::bit_cast<uint32_t>(y); });
}

LinearityCurve SlightlyBent() {
  LinearityCurve curve;
  curve.knots_dn = {0, 500, 4095};
  curve.corrected_dn = {0, 505, 4000};
  curve.variance_dn2 = {0, 0.5, 2};
  curve.from_dn = 100;
  curve.to_dn = 4095;
  return curve;
}

// Frames of which one was left out here and there.
void RejectSome(Stack& stack, std::mt19937& random) {
  stack.rejected_count = Image<uint8_t>(stack.size());
  for (int k = 0; k < 500; ++k) {
    stack.rejected_count.pixels()[random() % kSize.PixelCount()] = 1;
  }
}

TEST(ReduceBandTest, BandsGiveTheBitsOfTheStepsOnTheWholeImage) {
  std::mt19937 random(5);
  Calibration calibration = Calibrate(random);
  std::vector<Stack> stacks;
  for (const double t : kExposures) stacks.push_back(Draw(t, 90000, 3, random));
  RejectSome(stacks[1], random);
  for (const int period : {1, 2}) {
    if (period == 2) calibration.linearity = SlightlyBent();
    const ReduceOptions options{.saturation_dilation = 2,
                                .smoothing_radius = period == 1 ? 2 : 1,
                                .colour_period_px = period};
    const auto [plain, pair] = StepByStep(stacks, calibration, options);
    const ReducedRate banded = *ReduceRate(stacks, calibration, options);
    EXPECT_TRUE(SameBits(banded.rate.value, plain.value));
    EXPECT_TRUE(SameBits(banded.rate.variance, plain.variance));
    EXPECT_TRUE(std::ranges::equal(banded.rate.mask.pixels(), plain.mask.pixels()));
    EXPECT_EQ(banded.rate.history, plain.history);
    EXPECT_GT(banded.report.exposures.back().saturated, 0.5);
    EXPECT_NEAR(banded.report.pairs[0].ratio, 1, 0.02);
    EXPECT_EQ(banded.report.pairs[0].pixels, pair.pixels);
    EXPECT_NEAR(banded.report.pairs[0].ratio / pair.ratio, 1, 1e-9);
    EXPECT_NEAR(banded.report.pairs[0].sigma / pair.sigma, 1, 1e-6);
  }
}

TEST(ReduceBandTest, AStackOnAllProcessorsIsTheSumOfItsFrames) {
  std::mt19937 random(6);
  constexpr ImageSize kLarge{1100, 600};
  constexpr int kFrames = 40;  // more than 16 bits hold of 12-bit counts
  FrameStacker stacker({0.01, 0}, {12});
  Image<uint32_t> sum(kLarge);
  Image<uint8_t> saturated(kLarge);
  Image<uint16_t> frame(kLarge);
  for (int k = 0; k < kFrames; ++k) {
    for (size_t i = 0; i < frame.pixels().size(); ++i) {
      frame.pixels()[i] = static_cast<uint16_t>(random() & 4095);
      sum.pixels()[i] += frame.pixels()[i];
      saturated.pixels()[i] =
          static_cast<uint8_t>(saturated.pixels()[i] + (frame.pixels()[i] >= 4079 ? 1 : 0));
    }
    ASSERT_TRUE(stacker.Add({frame.pixels(), frame.size()}).ok());
  }
  const Stack stack = *stacker.Finish();
  EXPECT_TRUE(std::ranges::equal(stack.saturated_count.pixels(), saturated.pixels()));
  for (size_t i = 0; i < sum.pixels().size(); ++i) {
    ASSERT_EQ(stack.mean_dn.pixels()[i], static_cast<float>(sum.pixels()[i] * (1.0 / kFrames)));
  }
}

}  // namespace
}  // namespace eyebox::optics
