// A headset's grey series against the figures published of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "fit/activation/fit_activation.h"

namespace eyebox::fit {
namespace {

class AchromaticSeriesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file = std::filesystem::path(EYEBOX_SOURCE_DIR) /
                                       "../shared/reference/luminance/achromatic_420.csv";
    if (!std::filesystem::exists(file)) {
      GTEST_SKIP() << file << " is absent: no real series to fit";
    }
    const auto series = ReadLevelSeriesCsv(file);
    ASSERT_TRUE(series.ok()) << series.status();
    series_ = *series;
  }

  LevelSeries series_;
};

void Print(const ActivationFit& fit) {
  std::printf("%s, %s: rms %.3f %%, leave-one-out %.3f %%, AICc %.1f; %s\n",
              NameOf(fit.model).data(), NameOf(fit.weighting).data(), 100 * fit.rms_relative,
              100 * fit.leave_one_out_rms_relative, fit.aicc, fit.termination.c_str());
  for (const Parameter& parameter : fit.parameters) {
    std::printf("  %s = %.5f +- %.5f %s\n", parameter.name.c_str(), parameter.value,
                parameter.sigma, parameter.unit.c_str());
  }
}

TEST_F(AchromaticSeriesTest, UnweightedFitIsThePublishedOne) {
  const auto fit =
      FitActivation(series_, ActivationModel::kGammaWithCutoff, Weighting::kUnweighted);
  ASSERT_TRUE(fit.ok()) << fit.status();
  Print(*fit);
  EXPECT_NEAR(fit->activation.minimum_luminance, 0.775, 0.0006);
  EXPECT_NEAR(fit->activation.luminance_range, 420.75, 0.006);
  EXPECT_NEAR(fit->activation.cutoff_drive, 0.0335, 0.00006);
  EXPECT_NEAR(fit->activation.gamma, 3.071, 0.0006);
  EXPECT_NEAR(fit->rms_relative, 0.055, 0.0006);
  EXPECT_NEAR(fit->leave_one_out_rms_relative, 0.0605, 0.00006);
}

TEST_F(AchromaticSeriesTest, ChosenFitPredictsEveryLevelLeftOut) {
  const auto choice = ChooseActivation(series_);
  ASSERT_TRUE(choice.ok()) << choice.status();
  for (const ActivationFit& fit : choice->tried) Print(fit);
  std::printf("%s\n", choice->reason.c_str());
  EXPECT_EQ(choice->best.model, ActivationModel::kGammaWithCutoff);
  EXPECT_EQ(choice->best.weighting, Weighting::kRelative);
  EXPECT_LE(choice->best.leave_one_out_rms_relative, 0.012);
  EXPECT_GT(choice->best.leave_one_out_rms_relative, 0.010);
}

// The table of all models and weightings; relative weights are what matters, then the cutoff.
TEST_F(AchromaticSeriesTest, RelativeWeightsPredictBestWithEveryModel) {
  double least_unweighted = 1;
  double least_relative = 1;
  for (const ComparedActivation& entry : CompareActivations(series_)) {
    ASSERT_TRUE(entry.fit.ok()) << entry.fit.status();
    Print(*entry.fit);
    double& least = entry.weighting == Weighting::kRelative ? least_relative : least_unweighted;
    least = std::min(least, entry.fit->leave_one_out_rms_relative);
  }
  EXPECT_LT(least_relative, 0.012);
  EXPECT_GT(least_unweighted, 1.3 * least_relative);
}

}  // namespace
}  // namespace eyebox::fit
