// Reduction at the ends of everything: light, exposure, bits, size. Right mask, finite numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "optics/reduce/reduce_level.h"
#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

constexpr ImageSize kSmall{24, 16};
constexpr ImageSize kOnePixel{1, 1};

// A camera of `bits` whose noise, bias and gain fit them: 4 electrons a count at full scale of
// 12 bits, read noise of about a count.
ForwardCamera CameraOf(int bits, ImageSize size, uint64_t seed) {
  ForwardCamera camera(size, seed);
  camera.bits = bits;
  const double scale = std::ldexp(1.0, bits - 12);
  camera.gain_dn_per_e = 0.25 * scale;
  camera.bias_dn = bits == 8 ? 8 : 64 * scale;
  camera.read_sigma_dn = std::max(2 * scale, 0.6);
  return camera;
}

ReducedLevel Reduce(ForwardCamera& camera, float rate_e_s, const std::vector<double>& exposures_s,
                    const std::optional<KnownLuminance>& per_dn_s = std::nullopt) {
  Calibration calibration = camera.Calibrate(exposures_s, 32);
  calibration.luminance_of_one_dn_per_s = per_dn_s;
  std::vector<Stack> stacks;
  for (const double t : exposures_s) {
    stacks.push_back(camera.Record(Image<float>(camera.size(), rate_e_s), t, 4));
  }
  auto level = ReduceLevel(stacks, calibration);
  EXPECT_TRUE(level.ok()) << level.status();
  return *std::move(level);
}

void ExpectSoundNumbers(const ReducedLevel& level) {
  EXPECT_TRUE(KeepsMaskInvariant(level.luminance.image));
  const BracketReport& report = level.report;
  for (const double share : {report.invalid_share, report.all_saturated_share,
                             report.all_dark_share, report.hot_share}) {
    EXPECT_TRUE(share >= 0 && share <= 1) << share;
  }
  const VarianceBudget& budget = report.budget;
  for (const double term : {budget.photon, budget.read, budget.quantisation, budget.dark,
                            budget.flat, budget.linearity, budget.scatter, budget.scale}) {
    EXPECT_TRUE(std::isfinite(term) && term >= -1e-5) << term;
  }
}

struct Mean {
  double value = 0;
  double sigma = 0;
  size_t pixels = 0;
};

Mean MeanOf(const MeasuredImage& image) {
  Mean mean;
  double variance = 0;
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    if (image.mask.pixels()[i] != 0) continue;
    mean.value += image.value.pixels()[i];
    variance += image.variance.pixels()[i];
    ++mean.pixels;
  }
  mean.value /= static_cast<double>(mean.pixels);
  mean.sigma = std::sqrt(variance) / static_cast<double>(mean.pixels);
  return mean;
}

class ExtremesTest : public ::testing::TestWithParam<int> {};

// The exposure that puts the luminance at a third of full scale, whatever it is: 1e-6 to 100 s.
TEST_P(ExtremesTest, LuminanceOfNineDecadesComesBack) {
  const int bits = GetParam();
  for (const double luminance_cd_m2 : {1e-4, 1e-2, 1.0, 1e3, 1e5}) {
    const double exposure_s = std::clamp(0.01 / luminance_cd_m2, 1e-6, 100.0);
    ForwardCamera camera = CameraOf(bits, kSmall, 41);
    const double full_scale_e = std::ldexp(1.0, bits) / camera.gain_dn_per_e;
    const double rate_e_s = 0.33 * full_scale_e / exposure_s;
    const KnownLuminance per_dn_s{luminance_cd_m2 / (rate_e_s * camera.gain_dn_per_e), 0.01};
    const auto level = Reduce(camera, static_cast<float>(rate_e_s), {exposure_s}, per_dn_s);
    ExpectSoundNumbers(level);
    EXPECT_EQ(level.luminance.image.unit, "cd/m2");
    EXPECT_EQ(level.report.invalid_share, level.report.hot_share);
    const Mean mean = MeanOf(level.luminance.image);
    EXPECT_NEAR(mean.value, luminance_cd_m2, 5 * mean.sigma) << luminance_cd_m2 << " cd/m2";
    EXPECT_GT(level.report.budget.scale, 0);
  }
}

TEST_P(ExtremesTest, FaintestLightInALongBracketHasASigmaThatHolds) {
  ForwardCamera camera = CameraOf(GetParam(), kSmall, 42);
  const auto level = Reduce(camera, 0.5F, {1e-6, 1e-3, 1.0, 100.0});
  ExpectSoundNumbers(level);
  const Mean mean = MeanOf(level.luminance.image);
  EXPECT_GT(mean.pixels, kSmall.PixelCount() / 2);
  EXPECT_NEAR(mean.value, 0.5 * camera.gain_dn_per_e, 5 * mean.sigma);
}

TEST_P(ExtremesTest, AllSaturatedSaysSaturatedAndNothingElse) {
  for (const ImageSize size : {kSmall, kOnePixel}) {
    ForwardCamera camera = CameraOf(GetParam(), size, 43);
    const auto level = Reduce(camera, 1e12F, {1e-6, 1e-3, 1.0});
    ExpectSoundNumbers(level);
    EXPECT_EQ(level.report.all_saturated_share, 1);
    EXPECT_EQ(level.report.all_dark_share, 0);
    for (const uint8_t mask : level.luminance.image.mask.pixels()) EXPECT_EQ(mask, kSaturated);
  }
}

// The camera's black level is 0 DN: it clips the noise below, a wall that would bias the mean.
TEST_P(ExtremesTest, AllDarkAtTheWallSaysDarkAndNothingElse) {
  for (const ImageSize size : {kSmall, kOnePixel}) {
    ForwardCamera camera = CameraOf(GetParam(), size, 44);
    camera.bias_dn = 0;
    const auto level = Reduce(camera, 0, {1e-6, 1e-3, 1.0});
    ExpectSoundNumbers(level);
    EXPECT_EQ(level.report.all_dark_share + level.report.hot_share, 1);
    EXPECT_EQ(level.report.all_saturated_share, 0);
    for (const uint8_t mask : level.luminance.image.mask.pixels()) {
      EXPECT_TRUE((mask & kUnderexposed) != 0 || mask == kDefective);
      EXPECT_EQ(mask & kSaturated, 0);
    }
  }
}

TEST_P(ExtremesTest, OneValidExposureCarriesTheWholeBracket) {
  ForwardCamera camera = CameraOf(GetParam(), kSmall, 45);
  camera.bias_dn = 0;  // the shortest lies at the wall, the longest saturates
  const double full_scale_e = std::ldexp(1.0, GetParam()) / camera.gain_dn_per_e;
  const auto rate = static_cast<float>(0.5 * full_scale_e / 1e-2);
  const auto level = Reduce(camera, rate, {1e-6, 1e-2, 100.0});
  ExpectSoundNumbers(level);
  EXPECT_LT(level.report.invalid_share, 0.01);
  ASSERT_EQ(level.report.exposures.size(), 3U);
  EXPECT_EQ(level.report.exposures[0].valid, 0);
  EXPECT_GT(level.report.exposures[1].valid, 0.99);
  EXPECT_EQ(level.report.exposures[2].valid, 0);
  for (const ExposurePairCheck& pair : level.report.pairs) {
    EXPECT_EQ(pair.pixels, 0U);
    EXPECT_TRUE(std::isnan(pair.ratio));
  }
  const Mean mean = MeanOf(level.luminance.image);
  // Darks at the wall are not clean: half of their noise is cut off.
  EXPECT_NEAR(mean.value, rate * camera.gain_dn_per_e,
              5 * mean.sigma + camera.read_sigma_dn / 1e-2);
}

TEST_P(ExtremesTest, GapInTheBracketIsBothSaturatedAndDark) {
  ForwardCamera camera = CameraOf(GetParam(), kSmall, 46);
  camera.bias_dn = 0;
  const double full_scale_e = std::ldexp(1.0, GetParam()) / camera.gain_dn_per_e;
  const auto level = Reduce(camera, static_cast<float>(full_scale_e / 1e-2), {1e-6, 100.0});
  ExpectSoundNumbers(level);
  for (const uint8_t mask : level.luminance.image.mask.pixels()) {
    EXPECT_EQ(mask & ~kDefective, kSaturated | kUnderexposed);
  }
}

TEST_P(ExtremesTest, OnePixelIsAnImage) {
  ForwardCamera camera = CameraOf(GetParam(), kOnePixel, 47);
  const double full_scale_e = std::ldexp(1.0, GetParam()) / camera.gain_dn_per_e;
  const auto rate = static_cast<float>(0.3 * full_scale_e / 1e-2);
  const auto level = Reduce(camera, rate, {1e-3, 1e-2});
  ExpectSoundNumbers(level);
  const Mean mean = MeanOf(level.luminance.image);
  ASSERT_EQ(mean.pixels, 1U);
  EXPECT_NEAR(mean.value, rate * camera.gain_dn_per_e, 5 * mean.sigma);
}

INSTANTIATE_TEST_SUITE_P(Bits, ExtremesTest, ::testing::Values(8, 10, 12, 16),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace eyebox::optics
