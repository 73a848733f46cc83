#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/activation/fit_activation.h"
#include "tests/fit/activation/simulated_series.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

TEST(ChooseActivationTest, CutoffIsTakenWhereThereIsOne) {
  const auto choice = ChooseActivation(SimulateSeries({1, 100, 0.05, 2.2}, 17, 0.005));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kGammaWithCutoff);
  EXPECT_EQ(choice->best.weighting, Weighting::kMeasuredSigma);
  EXPECT_EQ(choice->tried.size(), 4U);
  EXPECT_THAT(choice->reason, HasSubstr("gamma_with_cutoff was taken"));
}

TEST(ChooseActivationTest, SimplerModelIsTakenWhereBothPredictAlike) {
  const auto choice = ChooseActivation(SimulateSeries({1, 100, 0, 2.2}, 17, 0));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kPowerOffset);
  EXPECT_EQ(choice->best.weighting, Weighting::kRelative);  // the series has no sigmas
}

TEST(ChooseActivationTest, OptionsAreObeyed) {
  ActivationOptions options;
  options.model = ActivationModel::kGammaWithCutoff;
  options.weighting = Weighting::kUnweighted;
  const auto choice = ChooseActivation(SimulateSeries({1, 100, 0, 2.2}, 17, 0.01), options);
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kGammaWithCutoff);
  EXPECT_EQ(choice->best.weighting, Weighting::kUnweighted);
  EXPECT_EQ(choice->tried.size(), 1U);
}

TEST(ChooseActivationTest, ModelThatCouldNotBeFittedIsSaid) {
  const auto choice = ChooseActivation(SimulateSeries({1, 100, 0, 2.2}, 4, 0));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model, ActivationModel::kPowerOffset);
  EXPECT_THAT(choice->reason, HasSubstr("gamma_with_cutoff was not fitted"));
}

TEST(ChooseActivationTest, LeftOutErrorOfAnExactModelIsWhatTheScatterPredicts) {
  for (const Weighting weighting : {Weighting::kMeasuredSigma, Weighting::kRelative}) {
    double left_out = 0;
    double predicted = 0;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
      LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0.01, seed);
      // A second reading of each level but the last.
      const LevelSeries more = SimulateSeries({1, 100, 0, 2.2}, 11, 0.01, seed + 1000);
      for (size_t i = 10; i-- > 0;) {
        series.readings.insert(series.readings.begin() + static_cast<int64_t>(i), more.readings[i]);
      }
      const auto fit = FitActivation(series, ActivationModel::kPowerOffset, weighting);
      ASSERT_TRUE(fit.ok()) << fit.status();
      left_out += fit->leave_one_out_rms_relative * fit->leave_one_out_rms_relative;
      predicted += LeftOutByScatter(*fit) * LeftOutByScatter(*fit);
    }
    EXPECT_NEAR(left_out / predicted, 1, 0.1);
  }
}

TEST(ChooseActivationTest, AWrongModelLeavesMoreThanItsSigmas) {
  const auto fit = FitActivation(SimulateSeries({1, 100, 0.05, 2.2}, 17, 0.002),
                                 ActivationModel::kPowerOffset, Weighting::kMeasuredSigma);
  ASSERT_TRUE(fit.ok()) << fit.status();
  EXPECT_GT(fit->leave_one_out_rms_relative, 3 * LeftOutByScatter(*fit));
  EXPECT_EQ(LeftOutByScatter(*FitActivation(SimulateSeries({1, 100, 0, 2.2}, 17, 0.002),
                                            ActivationModel::kPowerOffset, Weighting::kUnweighted)),
            0);
}

TEST(ChooseActivationTest, FlatLineIsAnErrorOfTheSeries) {
  LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0);
  for (LevelReading& reading : series.readings) reading.luminance = 3;
  const auto choice = ChooseActivation(series);
  EXPECT_EQ(choice.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(choice.status().message()), HasSubstr("simulated"));
}

}  // namespace
}  // namespace eyebox::fit
