// The whole reduction against a forward model: what was put in comes out, with honest sigmas.
#include "optics/reduce/reduce_level.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "optics/reduce/merge_bracket.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr ImageSize kSize{128, 96};
const std::vector<double> kBracket = {0.01, 0.04, 0.16};

Image<float> Gradient(float lowest, float highest) {
  Image<float> image(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      image.at(x, y) = lowest * std::pow(highest / lowest, static_cast<float>(x) / kSize.width_px);
    }
  }
  return image;
}

std::vector<Stack> RecordBracket(ForwardCamera& camera, const Image<float>& rate_e_s,
                                 const std::vector<double>& exposures_s, int frames) {
  std::vector<Stack> stacks;
  for (const double t : exposures_s) stacks.push_back(camera.Record(rate_e_s, t, frames));
  return stacks;
}

void ExpectHonestPulls(const PullStatistics& pulls) {
  EXPECT_GT(pulls.count, 1000);
  EXPECT_NEAR(pulls.rms, 1, 4 / std::sqrt(2 * pulls.count) + 0.01);
  EXPECT_NEAR(pulls.mean, 0, 4 / std::sqrt(pulls.count));
}

TEST(ReduceLevelTest, RateComesBackWithHonestSigmas) {
  ForwardCamera camera(kSize, 11);
  const Image<float> truth = Gradient(100, 2e6);
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto reduced = *ReduceRate(RecordBracket(camera, truth, kBracket, 2), calibration);
  EXPECT_TRUE(KeepsMaskInvariant(reduced.rate));
  EXPECT_GT(reduced.report.exposures.back().saturated, 0.2);
  ExpectHonestPulls(Pulls(reduced.rate, [&](size_t i) { return 0.25 * truth.pixels()[i]; }));
}

TEST(ReduceLevelTest, FlatRemovesVignettingAndSetsTheScale) {
  ForwardCamera camera(kSize, 12);
  std::mt19937_64 random(1);
  std::normal_distribution<float> pixel_response(1, 0.02F);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      const double r = std::hypot(x - 64, y - 48) / 80.0;
      camera.response.at(x, y) =
          static_cast<float>(std::pow(std::cos(std::atan(r)), 4)) * pixel_response(random);
    }
  }
  Calibration calibration = camera.Calibrate(kBracket, 16);
  const Image<float> uniform(kSize, 60000.0F);
  calibration.flat = *MeasureFlat(RecordBracket(camera, uniform, kBracket, 8), calibration,
                                  KnownLuminance{80, 0.015});
  const Image<float> truth = Gradient(3000, 300000);
  const auto level = *ReduceLevel(RecordBracket(camera, truth, kBracket, 2), calibration);
  EXPECT_TRUE(level.luminance.absolute);
  EXPECT_TRUE(level.luminance.flat_corrected);
  EXPECT_EQ(level.luminance.scale_relative_sigma, 0.015);
  EXPECT_TRUE(KeepsMaskInvariant(level.luminance.image));
  ExpectHonestPulls(
      Pulls(level.luminance.image, [&](size_t i) { return 80.0 / 60000 * truth.pixels()[i]; }));
  const VarianceBudget& budget = level.report.budget;
  EXPECT_NEAR(budget.photon + budget.read + budget.quantisation + budget.dark + budget.flat, 1,
              1e-3);
  EXPECT_GT(budget.flat, 0.02);
  EXPECT_GT(budget.photon, budget.read);
}

TEST(ReduceLevelTest, FlatOfUnknownLuminanceGivesARelativeImage) {
  ForwardCamera camera(kSize, 13);
  Calibration calibration = camera.Calibrate(kBracket, 4);
  const Image<float> uniform(kSize, 60000.0F);
  calibration.flat =
      *MeasureFlat(RecordBracket(camera, uniform, kBracket, 4), calibration, std::nullopt);
  EXPECT_NEAR(calibration.flat->response.value.at(64, 48), 1, 0.02);
  const auto level = *ReduceLevel(RecordBracket(camera, uniform, kBracket, 2), calibration);
  EXPECT_FALSE(level.luminance.absolute);
  EXPECT_TRUE(level.luminance.flat_corrected);
  EXPECT_EQ(level.luminance.image.unit, "relative");
  EXPECT_NEAR(level.luminance.image.value.at(64, 48), 15000, 400);  // DN/s in the reference region
}

TEST(ReduceLevelTest, WithoutAFlatTheResultSaysSo) {
  ForwardCamera camera(kSize, 14);
  const Calibration calibration = camera.Calibrate(kBracket, 4);
  const auto level =
      *ReduceLevel(RecordBracket(camera, Gradient(3000, 30000), kBracket, 2), calibration);
  EXPECT_FALSE(level.luminance.flat_corrected);
  EXPECT_THAT(level.luminance.image.history, ::testing::Contains(HasSubstr("no flat")));
}

// Mean of many pixels of equal truth, in electrons, for weights from the expectation and, to show
// why, for weights from each count itself.
struct MergeBias {
  double from_expectation = 0;
  double from_own_counts = 0;
  double sigma = 0;
};

MergeBias MeasureMergeBias(double electrons_in_longest) {
  constexpr ImageSize kMany{256, 256};
  ForwardCamera camera(kMany, 15);
  camera.read_sigma_dn = 0.5;
  camera.gain_dn_per_e = 1;
  const auto rate = static_cast<float>(electrons_in_longest / kBracket.back());
  const Image<float> truth(kMany, rate);
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto stacks = RecordBracket(camera, truth, kBracket, 1);
  const MeasuredImage merged = ReduceRate(stacks, calibration)->rate;
  std::vector<MeasuredImage> naive;
  for (const Stack& stack : stacks) {
    const double t = stack.setting.exposure_s;
    MeasuredImage image = MakeMeasuredImage(kMany, "DN/s");
    const auto& dark = (*FindDark(calibration, stack.setting))->image_dn;
    for (size_t i = 0; i < image.value.pixels().size(); ++i) {
      const double signal = stack.mean_dn.pixels()[i] - dark.value.pixels()[i];
      const double variance = calibration.noise.MeanVariance(signal, 1) + dark.variance.pixels()[i];
      image.value.pixels()[i] = static_cast<float>(signal / t);
      image.variance.pixels()[i] = static_cast<float>(variance / (t * t));
    }
    naive.push_back(std::move(image));
  }
  const MeasuredImage by_counts = *MergeBracket(naive);
  // Averaging the pixels by the variances they state: what every later fit does.
  const auto weighted_bias = [&](const MeasuredImage& image) {
    double weights = 0;
    double sum = 0;
    for (size_t i = 0; i < image.value.pixels().size(); ++i) {
      if (image.mask.pixels()[i] != 0) continue;
      weights += 1 / image.variance.pixels()[i];
      sum += image.value.pixels()[i] / image.variance.pixels()[i];
    }
    return sum / weights / rate - 1;
  };
  MergeBias bias{weighted_bias(merged), weighted_bias(by_counts)};
  bias.sigma =
      std::sqrt(1 / (1.3 * electrons_in_longest * static_cast<double>(kMany.PixelCount())));
  std::printf(
      "merge bias at %.0f electrons in the longest exposure: %.4f %% (weights from counts: "
      "%.2f %%), noise %.4f %%\n",
      electrons_in_longest, 100 * bias.from_expectation, 100 * bias.from_own_counts,
      100 * bias.sigma);
  return bias;
}

TEST(ReduceLevelTest, MergeIsUnbiasedAtLowCounts) {
  for (const double electrons : {10.0, 30.0, 100.0, 1000.0}) {
    const MergeBias bias = MeasureMergeBias(electrons);
    // A window of 25 pixels leaves 1/25 of the bias that a pixel's own count would make.
    EXPECT_NEAR(bias.from_expectation, 0, 4 * bias.sigma + 1.5 / 25 / electrons) << electrons;
    EXPECT_LT(bias.from_own_counts, -0.4 / electrons) << electrons;
  }
}

TEST(ReduceLevelTest, LinearSensorHasPairRatiosOfOne) {
  ForwardCamera camera(kSize, 16);
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto report =
      ReduceRate(RecordBracket(camera, Gradient(1000, 60000), kBracket, 2), calibration)->report;
  ASSERT_EQ(report.pairs.size(), 2U);
  for (const ExposurePairCheck& pair : report.pairs) {
    EXPECT_LT(pair.shorter_s, pair.longer_s);
    EXPECT_LT(pair.sigma, 0.005);
    EXPECT_NEAR(pair.ratio, 1, 4 * pair.sigma);
  }
}

TEST(ReduceLevelTest, NonlinearSensorIsFoundOut) {
  ForwardCamera camera(kSize, 17);
  camera.exponent = 0.97;
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto report =
      ReduceRate(RecordBracket(camera, Image<float>(kSize, 60000), kBracket, 2), calibration)
          ->report;
  for (const ExposurePairCheck& pair : report.pairs) {
    EXPECT_NEAR(pair.ratio, std::pow(4, -0.03), 0.003);  // 4^0.97 / 4
  }
}

TEST(ReduceLevelTest, AllSaturatedAndAllDarkAreToldApart) {
  ForwardCamera camera(kSize, 18);
  camera.bias_dn = 4;  // so low that the dark's noise is clipped
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto bright =
      *ReduceRate(RecordBracket(camera, Image<float>(kSize, 1e8F), kBracket, 2), calibration);
  EXPECT_EQ(bright.report.all_saturated_share, 1);
  EXPECT_EQ(CountFlagged(bright.rate, kSaturated), kSize.PixelCount());
  const auto dark =
      *ReduceRate(RecordBracket(camera, Image<float>(kSize, 0.0F), kBracket, 2), calibration);
  EXPECT_GT(dark.report.all_dark_share, 0.99);
  EXPECT_TRUE(KeepsMaskInvariant(bright.rate));
  EXPECT_TRUE(KeepsMaskInvariant(dark.rate));
}

TEST(ReduceLevelTest, BlackAboveTheBlackLevelIsMeasuredAndMayBeNegative) {
  ForwardCamera camera(kSize, 19);
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto reduced =
      *ReduceRate(RecordBracket(camera, Image<float>(kSize, 0.0F), kBracket, 2), calibration);
  EXPECT_EQ(reduced.report.invalid_share, 0);
  const auto values = reduced.rate.value.pixels();
  const auto negative = std::count_if(values.begin(), values.end(), [](float v) { return v < 0; });
  EXPECT_NEAR(static_cast<double>(negative) / static_cast<double>(values.size()), 0.5, 0.05);
  ExpectHonestPulls(Pulls(reduced.rate, [](size_t) { return 0.0; }));
}

TEST(ReduceLevelTest, SingleExposureIsABracketOfOne) {
  ForwardCamera camera(kSize, 20);
  const Calibration calibration = camera.Calibrate({0.04}, 16);
  const Image<float> truth = Gradient(3000, 100000);
  const auto reduced = *ReduceRate(RecordBracket(camera, truth, {0.04}, 1), calibration);
  EXPECT_TRUE(reduced.report.pairs.empty());
  ExpectHonestPulls(Pulls(reduced.rate, [&](size_t i) { return 0.25 * truth.pixels()[i]; }));
}

TEST(ReduceLevelTest, ExposuresFromAMicrosecondToMinutesReduceAlike) {
  for (const double t : {1e-6, 1e-3, 1.0, 100.0}) {
    ForwardCamera camera(kSize, 21);
    const Calibration calibration = camera.Calibrate({t}, 16);
    const Image<float> truth(kSize, static_cast<float>(4000 / t));
    const auto reduced = *ReduceRate(RecordBracket(camera, truth, {t}, 2), calibration);
    ExpectHonestPulls(Pulls(reduced.rate, [&](size_t i) { return 0.25 * truth.pixels()[i]; }));
  }
}

TEST(ReduceLevelTest, HotPixelsHaveNoNumber) {
  ForwardCamera camera(kSize, 22);
  camera.dark_rate_e_s.at(40, 30) = 50000;
  const Calibration calibration = camera.Calibrate(kBracket, 4);
  const auto reduced =
      *ReduceRate(RecordBracket(camera, Image<float>(kSize, 5000.0F), kBracket, 2), calibration);
  EXPECT_TRUE(reduced.rate.mask.at(40, 30) & kDefective);
  EXPECT_TRUE(std::isnan(reduced.rate.value.at(40, 30)));
  EXPECT_DOUBLE_EQ(reduced.report.hot_share, 1.0 / static_cast<double>(kSize.PixelCount()));
}

TEST(ReduceLevelTest, MosaicOfUnequalColoursKeepsHonestSigmas) {
  ForwardCamera camera(kSize, 23);
  Image<float> truth(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      truth.at(x, y) = (x + y) % 2 == 0 ? 60000.0F : 900.0F;
    }
  }
  const Calibration calibration = camera.Calibrate(kBracket, 16);
  const auto reduced = *ReduceRate(RecordBracket(camera, truth, kBracket, 2), calibration);
  ExpectHonestPulls(Pulls(reduced.rate, [&](size_t i) { return 0.25 * truth.pixels()[i]; }));
}

TEST(ReduceLevelTest, MissingDarkIsRejectedAndNamed) {
  ForwardCamera camera(kSize, 24);
  const Calibration calibration = camera.Calibrate({0.01}, 2);
  const auto reduced =
      ReduceRate(RecordBracket(camera, Image<float>(kSize, 900.0F), {0.01, 0.04}, 1), calibration);
  EXPECT_EQ(reduced.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(reduced.status().message()),
              ::testing::AllOf(HasSubstr("exposure 0.04 s"), HasSubstr("[exposure 0.01 s")));
}

TEST(ReduceLevelTest, TwoStacksOfOneExposureAreRejected) {
  ForwardCamera camera(kSize, 25);
  const Calibration calibration = camera.Calibrate({0.01}, 2);
  const auto stacks = RecordBracket(camera, Image<float>(kSize, 900.0F), {0.01, 0.01}, 1);
  EXPECT_EQ(ReduceRate(stacks, calibration).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(ReduceLevelTest, NoiseModelOfAnotherGainIsRejected) {
  ForwardCamera camera(kSize, 26);
  Calibration calibration = camera.Calibrate({0.01}, 2);
  calibration.noise.gain_db = 6;
  const auto stacks = RecordBracket(camera, Image<float>(kSize, 900.0F), {0.01}, 1);
  EXPECT_EQ(ReduceRate(stacks, calibration).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(ReduceLevelTest, FlatWithoutLightIsRejected) {
  ForwardCamera camera(kSize, 27);
  const Calibration calibration = camera.Calibrate({0.01}, 2);
  const auto stacks = RecordBracket(camera, Image<float>(kSize, 0.0F), {0.01}, 2);
  EXPECT_EQ(MeasureFlat(stacks, calibration, std::nullopt).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(ReduceLevelTest, EmptyBracketIsRejected) {
  EXPECT_EQ(ReduceRate({}, {}).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(ReduceLevelTest, HistoryNamesEveryStepInOrder) {
  ForwardCamera camera(kSize, 28);
  Calibration calibration = camera.Calibrate({0.01}, 2);
  const auto stacks = RecordBracket(camera, Image<float>(kSize, 60000.0F), {0.01}, 2);
  calibration.flat = *MeasureFlat(stacks, calibration, KnownLuminance{10, 0.01});
  const auto level = *ReduceLevel(stacks, calibration);
  EXPECT_THAT(level.luminance.image.history,
              ::testing::ElementsAre(HasSubstr("MeasureStack("), HasSubstr("SubtractDark("),
                                     HasSubstr("DivideByExposure("), HasSubstr("MergeBracket("),
                                     HasSubstr("DivideByFlat("), HasSubstr("ScaleLuminance(")));
}

}  // namespace
}  // namespace eyebox::optics
