#include "optics/reduce/match_dark.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/optics/forward_model.h"

namespace eyebox::optics {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr ImageSize kSize{160, 120};
constexpr double kCold = 25;
constexpr Setting kLong{1, 0};
constexpr Setting kShort{0.01, 0};

// 40 electrons per second at 25 degC, twice that with every 7 K: 10 DN in a second.
class MatchDarkTest : public testing::Test {
 protected:
  MatchDarkTest() : camera_(kSize, 67) { calibration_.noise = camera_.TrueNoise(); }

  static double RateAt(double temperature_degC) {
    return 40 * std::exp2((temperature_degC - kCold) / 7);
  }
  double MeanAt(double temperature_degC) const {
    return camera_.bias_dn + camera_.gain_dn_per_e * RateAt(temperature_degC) * kLong.exposure_s;
  }

  void AddDarks(double temperature_degC) {
    for (float& rate : camera_.dark_rate_e_s.pixels()) {
      rate = static_cast<float>(RateAt(temperature_degC));
    }
    for (const Setting& setting : {kShort, kLong}) {
      Stack dark = camera_.RecordDark(setting.exposure_s, 16);
      dark.temperature_degC = temperature_degC;
      stacks_.push_back(std::move(dark));
    }
  }

  void Finish() {
    calibration_.defects = *FindHotPixels(stacks_);
    for (const Stack& dark : stacks_) {
      calibration_.darks.push_back(*MeasureDark(dark, calibration_.noise));
    }
    StateDarkCurrents(calibration_);
  }

  ForwardCamera camera_;
  Calibration calibration_;
  std::vector<Stack> stacks_;
};

double MeanOf(const MeasuredImage& image) {
  double sum = 0;
  for (const float value : image.value.pixels()) sum += value;
  return sum / static_cast<double>(image.value.pixels().size());
}

TEST_F(MatchDarkTest, DarkCurrentIsTheGrowthWithExposure) {
  AddDarks(kCold);
  Finish();
  EXPECT_NEAR(*calibration_.darks[1].dark_current_dn, 10, 0.05);
  EXPECT_NEAR(*calibration_.darks[0].dark_current_dn, 0.1, 0.0005);
}

TEST_F(MatchDarkTest, TheErrorDoublesWithFiveKelvin) {
  DarkFrame dark;
  dark.dark_current_dn = 4;
  EXPECT_EQ(ThermalErrorDn(dark, 30, {}), 0) << "it tells no temperature";
  dark.temperature_degC = kCold;
  EXPECT_DOUBLE_EQ(ThermalErrorDn(dark, kCold, {}), 0);
  EXPECT_DOUBLE_EQ(ThermalErrorDn(dark, kCold + 5, {}), 4);
  EXPECT_DOUBLE_EQ(ThermalErrorDn(dark, kCold - 5, {}), 2);
}

TEST_F(MatchDarkTest, AnUnknownDarkCurrentIsBoundedByTheNoise) {
  DarkFrame dark;
  dark.temperature_degC = kCold;
  NoiseModel noise;
  noise.gain_dn_per_e = 0.25;
  noise.read_variance_dn2 = 0.5;  // at most 2 DN of dark current
  EXPECT_DOUBLE_EQ(ThermalErrorDn(dark, kCold + 5, noise), 2);
}

TEST_F(MatchDarkTest, ADarkOfTheSameTemperatureIsTakenAsItIs) {
  AddDarks(kCold);
  AddDarks(kCold + 4);
  Finish();
  const auto dark = DarkFor(calibration_, kLong, kCold + 4.01);
  ASSERT_TRUE(dark.ok()) << dark.status();
  EXPECT_EQ(dark->get(), &calibration_.darks[3]);
}

TEST_F(MatchDarkTest, ANearDarkCountsWhatItMayBeOffBy) {
  AddDarks(kCold);
  Finish();
  const double light_degC = kCold + 0.5;
  const auto dark = DarkFor(calibration_, kLong, light_degC);
  ASSERT_TRUE(dark.ok()) << dark.status();
  const DarkFrame& as_recorded = calibration_.darks[1];
  EXPECT_EQ(MeanOf((*dark)->image_dn), MeanOf(as_recorded.image_dn));
  const double error_dn = ThermalErrorDn(as_recorded, light_degC, calibration_.noise);
  EXPECT_GT(error_dn, MeanAt(light_degC) - MeanAt(kCold));
  EXPECT_NEAR((*dark)->image_dn.variance.at(3, 3) - as_recorded.image_dn.variance.at(3, 3),
              error_dn * error_dn, 1e-5);
  EXPECT_THAT((*dark)->image_dn.history,
              Contains(AllOf(HasSubstr("MatchDark(dark of 25 degC"), HasSubstr("25.5 degC"))));
}

TEST_F(MatchDarkTest, BetweenTwoTemperaturesItIsInterpolated) {
  AddDarks(kCold);
  AddDarks(kCold + 2);
  Finish();
  const double light_degC = kCold + 1.2;
  const auto dark = DarkFor(calibration_, kLong, light_degC);
  ASSERT_TRUE(dark.ok()) << dark.status();
  const auto& history = (*dark)->image_dn.history;
  ASSERT_THAT(history, Contains(HasSubstr("MatchDark(darks of 25 and 27 degC")));
  const double statistical_dn = 2 / std::sqrt(16.0 * kSize.PixelCount());
  EXPECT_NEAR(MeanOf((*dark)->image_dn), MeanAt(light_degC), 0.06 + 4 * statistical_dn);
  EXPECT_GT(MeanAt(light_degC) - MeanAt(kCold), 1) << "the nearest would have been off";
}

TEST_F(MatchDarkTest, ADarkTooFarAwayIsRefusedWithBothTemperatures) {
  AddDarks(kCold);
  Finish();
  const absl::Status status = DarkFor(calibration_, kLong, 31).status();
  EXPECT_TRUE(absl::IsFailedPrecondition(status)) << status;
  EXPECT_THAT(std::string(status.message()),
              AllOf(HasSubstr("taken at 31 degC"), HasSubstr("nearest dark at 25 degC"),
                    HasSubstr("record darks between the lights")));
  EXPECT_TRUE(DarkFor(calibration_, kShort, 31).ok()) << "0.1 DN there, which nobody sees";
}

TEST_F(MatchDarkTest, AStackHasATemperatureWhereAllFramesTellOne) {
  const Image<uint16_t> frame(kSize, 100);
  const FrameView view{frame.pixels(), frame.size()};
  const auto stacked = [&](const std::vector<std::optional<double>>& temperatures) {
    FrameStacker stacker(kLong, camera_.Range());
    for (const auto& temperature : temperatures) EXPECT_TRUE(stacker.Add(view, temperature).ok());
    return stacker.Finish()->temperature_degC;
  };
  EXPECT_EQ(stacked({25, 27}), 26);
  EXPECT_EQ(stacked({25, std::nullopt}), std::nullopt);
  EXPECT_EQ(stacked({25, std::numeric_limits<double>::quiet_NaN()}), std::nullopt);
}

TEST_F(MatchDarkTest, ALightWithoutATemperatureNeedsDarksThatAgree) {
  AddDarks(kCold);
  Finish();
  EXPECT_EQ(DarkFor(calibration_, kLong, std::nullopt)->get(), &calibration_.darks[1]);
  stacks_.clear();
  AddDarks(kCold + 6);
  Finish();
  EXPECT_THAT(std::string(DarkFor(calibration_, kLong, std::nullopt).status().message()),
              AllOf(HasSubstr("tells no temperature"), HasSubstr("25 and 31 degC")));
}

}  // namespace
}  // namespace eyebox::optics
