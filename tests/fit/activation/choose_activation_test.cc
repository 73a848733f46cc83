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

TEST(ChooseActivationTest, FlatLineIsAnErrorOfTheSeries) {
  LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 11, 0);
  for (LevelReading& reading : series.readings) reading.luminance = 3;
  const auto choice = ChooseActivation(series);
  EXPECT_EQ(choice.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(choice.status().message()), HasSubstr("simulated"));
}

}  // namespace
}  // namespace eyebox::fit
