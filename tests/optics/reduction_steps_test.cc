// Each step against values worked out by hand, and its variance against Monte Carlo.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "optics/photometry/scale_luminance.h"
#include "optics/reduce/average_repeats.h"
#include "optics/reduce/box_mean.h"
#include "optics/reduce/compare_exposures.h"
#include "optics/reduce/divide_by_exposure.h"
#include "optics/reduce/divide_by_flat.h"
#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/subtract_dark.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;

MeasuredImage OnePixel(float value, float variance, const std::string& unit, uint8_t mask = 0) {
  MeasuredImage image = MakeMeasuredImage({1, 1}, unit);
  image.value.at(0, 0) = value;
  image.variance.at(0, 0) = variance;
  image.mask.at(0, 0) = mask;
  BlankMaskedPixels(image);
  return image;
}

float Value(const MeasuredImage& image) { return image.value.at(0, 0); }
float Variance(const MeasuredImage& image) { return image.variance.at(0, 0); }
uint8_t Mask(const MeasuredImage& image) { return image.mask.at(0, 0); }

TEST(SubtractDarkTest, SubtractsAndAddsVariances) {
  const auto image =
      *SubtractDark(OnePixel(100, 9, "DN"), {0.1, 0}, {{0.1, 0}, OnePixel(64, 4, "DN")});
  EXPECT_EQ(Value(image), 36);
  EXPECT_EQ(Variance(image), 13);
  EXPECT_THAT(image.history.back(), HasSubstr("SubtractDark(exposure 0.1 s"));
}

TEST(SubtractDarkTest, NegativeValuesAreKept) {
  const auto image =
      *SubtractDark(OnePixel(60, 9, "DN"), {0.1, 0}, {{0.1, 0}, OnePixel(64, 4, "DN")});
  EXPECT_EQ(Value(image), -4);
  EXPECT_EQ(Mask(image), 0);
}

TEST(SubtractDarkTest, DarkOfAnotherExposureIsRejected) {
  const auto image =
      SubtractDark(OnePixel(100, 9, "DN"), {0.1, 0}, {{0.2, 0}, OnePixel(64, 4, "DN")});
  EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("exposure 0.2 s"));
}

TEST(SubtractDarkTest, DarkOfAnotherGainIsRejected) {
  const auto image =
      SubtractDark(OnePixel(100, 9, "DN"), {0.1, 0}, {{0.1, 6}, OnePixel(64, 4, "DN")});
  EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(SubtractDarkTest, MaskedDarkMasksTheLight) {
  const auto image = *SubtractDark(OnePixel(100, 9, "DN"), {0.1, 0},
                                   {{0.1, 0}, OnePixel(64, 4, "DN", kSaturated)});
  EXPECT_EQ(Mask(image), kSaturated);
  EXPECT_TRUE(KeepsMaskInvariant(image));
}

TEST(DivideByExposureTest, ScalesValueAndVariance) {
  const auto image = *DivideByExposure(OnePixel(36, 13, "DN"), 0.5);
  EXPECT_EQ(Value(image), 72);
  EXPECT_EQ(Variance(image), 52);
  EXPECT_EQ(image.unit, "DN/s");
}

TEST(DivideByExposureTest, ExposureThatIsNotAboveZeroIsRejected) {
  for (const double t : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(DivideByExposure(OnePixel(36, 13, "DN"), t).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
}

TEST(DivideByFlatTest, PropagatesTheVarianceOfTheFlat) {
  const auto image = *DivideByFlat(OnePixel(6, 4, "DN/s"), OnePixel(2, 0.01F, "DN/s"), 0.05);
  EXPECT_EQ(Value(image), 3);
  EXPECT_FLOAT_EQ(Variance(image), (4 + 9 * 0.01F) / 4);
  EXPECT_EQ(image.unit, "1");
}

TEST(DivideByFlatTest, VarianceAgreesWithMonteCarlo) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int kTrials = 40000;
  double sum = 0;
  double squares = 0;
  for (int k = 0; k < kTrials; ++k) {
    const double ratio = (6 + 0.3 * normal(random)) / (2 + 0.04 * normal(random));
    sum += ratio;
    squares += ratio * ratio;
  }
  const double variance = squares / kTrials - std::pow(sum / kTrials, 2);
  const auto image = *DivideByFlat(OnePixel(6, 0.09F, "1"), OnePixel(2, 0.0016F, "1"), 0.05);
  EXPECT_NEAR(Variance(image) / variance, 1, 4 * std::sqrt(2.0 / kTrials) + 0.002);
}

TEST(DivideByFlatTest, WeakOrMissingFlatMasksThePixel) {
  MeasuredImage flat = MakeMeasuredImage({4, 1}, "DN/s");
  MeasuredImage image = MakeMeasuredImage({4, 1}, "DN/s");
  for (int x = 0; x < 4; ++x) {
    image.value.at(x, 0) = 10;
    image.variance.at(x, 0) = 1;
    flat.value.at(x, 0) = 100;
    flat.variance.at(x, 0) = 1;
  }
  flat.value.at(1, 0) = 4;        // below 5 % of the median
  flat.variance.at(2, 0) = 1000;  // not above 5 sigma
  flat.mask.at(3, 0) = kDefective;
  BlankMaskedPixels(flat);
  image = *DivideByFlat(std::move(image), flat, 0.05);
  EXPECT_THAT(image.mask.pixels(), ::testing::ElementsAre(0, kNoFlat, kNoFlat, kNoFlat));
  EXPECT_TRUE(KeepsMaskInvariant(image));
}

TEST(DivideByFlatTest, FlatWithoutLightIsRejected) {
  EXPECT_EQ(DivideByFlat(OnePixel(1, 1, "1"), OnePixel(-1, 1, "1"), 0.05).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(MergeBracketTest, WeighsByInverseVariance) {
  const auto merged = *MergeBracket(std::vector{OnePixel(10, 4, "DN/s"), OnePixel(13, 1, "DN/s"),
                                                OnePixel(0, 1, "DN/s", kSaturated)});
  EXPECT_FLOAT_EQ(Value(merged), (10 * 0.25F + 13) / 1.25F);
  EXPECT_FLOAT_EQ(Variance(merged), 0.8F);
  EXPECT_EQ(Mask(merged), 0);
}

TEST(MergeBracketTest, ReasonsOfAnInvalidPixelTellSaturatedFromDarkFromAGap) {
  const auto merge = [](uint8_t shorter, uint8_t longer) {
    const auto merged =
        *MergeBracket(std::vector{OnePixel(1, 1, "DN/s", shorter), OnePixel(1, 1, "DN/s", longer)});
    EXPECT_TRUE(KeepsMaskInvariant(merged));
    return Mask(merged);
  };
  EXPECT_EQ(merge(kSaturated, kSaturated), kSaturated);
  EXPECT_EQ(merge(kUnderexposed, kUnderexposed), kUnderexposed);
  EXPECT_EQ(merge(kUnderexposed, kSaturated), kUnderexposed | kSaturated);
  EXPECT_EQ(merge(kUnderexposed, 0), 0);
}

TEST(MergeBracketTest, ExposuresFromMicrosecondsToMinutesKeepTheirPrecision) {
  BracketMerger merger;
  double weight = 0;
  double weighted = 0;
  for (const double t : {1e-6, 1e-3, 1.0, 100.0}) {
    const auto dn = static_cast<float>(0.37 * t);
    const auto rate = *DivideByExposure(OnePixel(dn, 5, "DN"), t);
    weight += t * t / 5;
    weighted += t * t / 5 * (dn / t);
    ASSERT_TRUE(merger.Add(rate).ok());
  }
  const auto merged = *merger.Finish();
  EXPECT_NEAR(Value(merged) / (weighted / weight), 1, 1e-6);
  EXPECT_NEAR(Variance(merged) * weight, 1, 1e-6);
}

TEST(MergeBracketTest, ShortestExposureAloneIsFinite) {
  const auto rate = *DivideByExposure(OnePixel(4000, 1000, "DN"), 1e-6);
  const auto merged = *MergeBracket(std::vector{rate});
  EXPECT_FLOAT_EQ(Value(merged), 4e9F);
  EXPECT_TRUE(KeepsMaskInvariant(merged));
}

TEST(MergeBracketTest, EmptyBracketIsRejected) {
  EXPECT_EQ(MergeBracket({}).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST(AverageRepeatsTest, MeanOfTheValidOnes) {
  const auto mean = *AverageRepeats(
      std::vector{OnePixel(10, 1, "1"), OnePixel(11, 3, "1"), OnePixel(0, 1, "1", kSaturated)});
  EXPECT_FLOAT_EQ(Value(mean), 10.5F);
  EXPECT_FLOAT_EQ(Variance(mean), 1);
}

TEST(AverageRepeatsTest, OutlierAmongThreeIsLeftOut) {
  const auto mean = *AverageRepeats(
      std::vector{OnePixel(10, 1, "1"), OnePixel(40, 1, "1"), OnePixel(11, 1, "1")});
  EXPECT_FLOAT_EQ(Value(mean), 10.5F);
  EXPECT_THAT(mean.history.back(), HasSubstr("1 left out"));
}

TEST(AverageRepeatsTest, PixelWithoutAnyRepeatStaysInvalid) {
  const auto mean = *AverageRepeats(std::vector{OnePixel(10, 1, "1", kDefective)});
  EXPECT_EQ(Mask(mean), kDefective);
  EXPECT_TRUE(KeepsMaskInvariant(mean));
}

TEST(ScaleLuminanceTest, KeepsTheCommonUncertaintyApart) {
  const auto luminance =
      *ScaleLuminance(OnePixel(0.5F, 0.01F, "1"), true, KnownLuminance{100, 0.02});
  EXPECT_FLOAT_EQ(Value(luminance.image), 50);
  EXPECT_FLOAT_EQ(Variance(luminance.image), 100);
  EXPECT_EQ(luminance.scale_relative_sigma, 0.02);
  EXPECT_TRUE(luminance.absolute);
  EXPECT_EQ(luminance.image.unit, "cd/m2");
}

TEST(ScaleLuminanceTest, WithoutAKnownLuminanceItIsRelative) {
  const auto luminance = *ScaleLuminance(OnePixel(0.5F, 0.01F, "1"), true, std::nullopt);
  EXPECT_FALSE(luminance.absolute);
  EXPECT_EQ(luminance.image.unit, "relative");
  EXPECT_FLOAT_EQ(Value(luminance.image), 0.5F);
}

TEST(ScaleLuminanceTest, ImpossibleLuminanceIsRejected) {
  EXPECT_FALSE(ScaleLuminance(OnePixel(1, 1, "1"), true, KnownLuminance{0, 0.02}).ok());
  EXPECT_FALSE(ScaleLuminance(OnePixel(1, 1, "1"), true, KnownLuminance{10, -0.1}).ok());
}

TEST(BoxMeanTest, StaysWithinOneColourAndLeavesInvalidPixelsOut) {
  Image<float> image({6, 1});
  const std::vector<float> values = {1, 100, 3, 200, kNoValue, 300};
  std::copy(values.begin(), values.end(), image.pixels().begin());
  const Image<float> mean = BoxMean(image, 1, 2);
  EXPECT_THAT(mean.pixels(), ::testing::ElementsAre(2, 150, 2, 200, 3, 250));
}

TEST(BoxMeanTest, IsTheMeanOfEachWindow) {
  std::mt19937 random(4);
  Image<float> image({23, 17});
  for (float& pixel : image.pixels()) {
    pixel = random() % 7 == 0 ? kNoValue : static_cast<float>(random() % 1000);
  }
  for (const int radius : {1, 2, 3}) {
    for (const int step : {1, 2}) {
      const Image<float> mean = BoxMean(image, radius, step);
      for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < 23; ++x) {
          double sum = 0;
          int count = 0;
          for (int j = y - radius * step; j <= y + radius * step; j += step) {
            for (int i = x - radius * step; i <= x + radius * step; i += step) {
              if (i < 0 || i >= 23 || j < 0 || j >= 17 || std::isnan(image.at(i, j))) continue;
              sum += image.at(i, j);
              ++count;
            }
          }
          ASSERT_FLOAT_EQ(mean.at(x, y), static_cast<float>(sum / count));
        }
      }
    }
  }
}

TEST(BoxMeanTest, WindowOfNothingHasNoMean) {
  const Image<float> mean = BoxMean(Image<float>({3, 3}, kNoValue), 1, 1);
  EXPECT_TRUE(std::isnan(mean.at(1, 1)));
}

TEST(CompareExposuresTest, RatioAndSigmaByHand) {
  const Image<float> expected({1, 1}, 10.0F);
  const auto check =
      CompareExposures(OnePixel(10, 1, "DN/s"), 0.1, OnePixel(11, 0.25F, "DN/s"), 0.2, expected);
  EXPECT_DOUBLE_EQ(check.ratio, 1.1);
  EXPECT_NEAR(check.sigma, std::sqrt(0.25 + 1.21) / 10, 1e-12);
  EXPECT_EQ(check.pixels, 1U);
}

TEST(CompareExposuresTest, WithoutSignalThereIsNoRatio) {
  const Image<float> expected({1, 1}, 0.1F);
  const auto check =
      CompareExposures(OnePixel(0.1F, 1, "DN/s"), 0.1, OnePixel(0.1F, 1, "DN/s"), 0.2, expected);
  EXPECT_TRUE(std::isnan(check.ratio));
  EXPECT_TRUE(std::isnan(check.sigma));
  EXPECT_EQ(check.pixels, 1U);
}

}  // namespace
}  // namespace eyebox::optics
