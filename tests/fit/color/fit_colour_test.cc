#include "fit/color/fit_colour.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/color/synthetic_display.h"

namespace eyebox::fit {
namespace {

constexpr int kLevels = 10;

std::vector<Rgb> WithMixtures() {
  std::vector<Rgb> drives = GreysAndPrimaries(kLevels);
  for (double v : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    drives.insert(drives.end(), {{v, v, 0}, {v, 0, v}, {0, v, v}});
  }
  return drives;
}

// Of about 20 parameters one lies beyond 3 sigma in every 18th fit, if the sigmas are honest.
void ExpectWithinThreeSigma(const ColourFit& fit, const ColourModel& truth) {
  const std::vector<double> values = truth.ToParameters();
  ASSERT_EQ(fit.parameters.size(), values.size());
  int beyond = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = fit.parameters[i];
    EXPECT_GT(parameter.sigma, 0) << parameter.name;
    const double sigmas = std::abs(parameter.value - values[i]) / parameter.sigma;
    EXPECT_LE(sigmas, 4) << parameter.name << " " << parameter.value << " +- " << parameter.sigma
                         << ", truth " << values[i];
    beyond += sigmas > 3 ? 1 : 0;
  }
  EXPECT_LE(beyond, 1);
}

TEST(FitColourTest, SigmasSayHowFarTheTruthIs) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.045});
  const std::vector<double> values = truth.ToParameters();
  double squares = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto fit = FitColour(Measure(truth, GreysAndPrimaries(kLevels), 0.005, seed),
                               ColourModelKind::kDriveCrosstalk);
    ASSERT_TRUE(fit.ok()) << fit.status();
    for (size_t i = 0; i < values.size(); ++i) {
      const double sigmas = (fit->parameters[i].value - values[i]) / fit->parameters[i].sigma;
      squares += sigmas * sigmas;
      ++count;
    }
  }
  EXPECT_GT(std::sqrt(squares / count), 0.7);
  EXPECT_LT(std::sqrt(squares / count), 1.3);
}

TEST(FitColourTest, AdditiveDisplayIsRecoveredAndPassesTheTest) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  for (unsigned seed : {1u, 2u, 3u}) {
    const auto choice = ChooseColour(Measure(truth, GreysAndPrimaries(kLevels), 0.005, seed));
    ASSERT_TRUE(choice.ok()) << choice.status();
    EXPECT_EQ(choice->best.model.kind, ColourModelKind::kAdditive) << choice->reason;
    EXPECT_TRUE(choice->additivity.tested);
    EXPECT_TRUE(choice->additivity.passed) << choice->additivity.verdict;
    EXPECT_TRUE(choice->certified) << choice->verdict;
    ExpectWithinThreeSigma(choice->best, truth);
  }
}

TEST(FitColourTest, CrosstalkIsDetectedAndRecovered) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.045});
  const auto choice = ChooseColour(Measure(truth, GreysAndPrimaries(kLevels), 0.005, 7));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model.kind, ColourModelKind::kDriveCrosstalk) << choice->reason;
  EXPECT_FALSE(choice->additivity.passed);
  EXPECT_LT(choice->additivity.mean_departure[1], -0.03);
  EXPECT_TRUE(choice->certified) << choice->verdict;
  EXPECT_FALSE(choice->mixtures_measured);
  ExpectWithinThreeSigma(choice->best, truth);
}

TEST(FitColourTest, PairwiseCrosstalkNeedsMixturesAndIsFoundWithThem) {
  const ColourModel truth =
      SyntheticDisplay(ColourModelKind::kPairwiseCrosstalk, {0.08, 0, 0, 0.04, 0.06, 0});
  const auto blind = FitColour(Measure(truth, GreysAndPrimaries(kLevels), 0.005, 3),
                               ColourModelKind::kPairwiseCrosstalk);
  const auto choice = ChooseColour(Measure(truth, WithMixtures(), 0.005, 3));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model.kind, ColourModelKind::kPairwiseCrosstalk) << choice->reason;
  EXPECT_TRUE(choice->mixtures_measured);
  ExpectWithinThreeSigma(choice->best, truth);
  if (blind.ok()) {  // hardly determined: the sigmas must say so
    EXPECT_GT(blind->parameters[18].sigma, 5 * choice->best.parameters[18].sigma);
  }
}

TEST(FitColourTest, DisplayThatDimsWhenBrightIsFoundAsGain) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kActivationGain, {-0.1, -0.1, -0.1});
  const auto choice = ChooseColour(Measure(truth, GreysAndPrimaries(kLevels), 0.005, 5));
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_EQ(choice->best.model.kind, ColourModelKind::kActivationGain) << choice->reason;
  EXPECT_FALSE(choice->additivity.passed);
  EXPECT_GT(choice->additivity.max_departure, 0.05);
  ExpectWithinThreeSigma(choice->best, truth);
}

TEST(FitColourTest, NoiselessSeriesIsRecoveredToRounding) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.045});
  const auto fit =
      FitColour(Measure(truth, GreysAndPrimaries(kLevels), 0, 1), ColourModelKind::kDriveCrosstalk);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const std::vector<double> values = truth.ToParameters();
  for (size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(fit->parameters[i].value, values[i], 1e-6 * std::max(1.0, std::abs(values[i])))
        << fit->parameters[i].name;
  }
}

TEST(FitColourTest, WhiteSubpixelThatNoModelHoldsIsNotCertified) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  ColourSeries series = Measure(truth, WithMixtures(), 0.003, 2);
  for (ColourReading& reading : series.readings) {
    const double white = std::min({reading.drive[0], reading.drive[1], reading.drive[2]});
    const double added = 60 * std::pow(white, 6);
    reading.colour = Plus(reading.colour, {added, added, added});
  }
  const auto choice = ChooseColour(series);
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_FALSE(choice->certified) << choice->verdict;
  EXPECT_NE(choice->verdict.find("colour not certified"), std::string::npos);
}

TEST(FitColourTest, ChannelThatChangesItsChromaticityIsNotCertified) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  ColourSeries series = Measure(truth, GreysAndPrimaries(kLevels), 0.001, 2);
  for (ColourReading& reading : series.readings) {
    if (reading.drive[2] > 0 && reading.drive[0] == 0) {
      reading.colour[0] *= 1.2 - 0.2 * reading.drive[2];
    }
  }
  const auto choice = ChooseColour(series);
  ASSERT_TRUE(choice.ok()) << choice.status();
  EXPECT_FALSE(choice->constancy[2].passed);
  EXPECT_TRUE(choice->constancy[0].passed);
  EXPECT_FALSE(choice->certified);
}

TEST(FitColourTest, DisplayWithoutBlackLightIsFitted) {
  ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  truth.background = {0, 0, 0};
  const auto fit =
      FitColour(Measure(truth, GreysAndPrimaries(kLevels), 0.002, 4), ColourModelKind::kAdditive);
  ASSERT_TRUE(fit.ok()) << fit.status();
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(fit->model.background[c], 0, 0.02);
  for (const Parameter& parameter : fit->parameters) {
    EXPECT_TRUE(std::isfinite(parameter.sigma)) << parameter.name;
  }
}

TEST(FitColourTest, RepeatedStimuliAreLeftOutTogether) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  std::vector<Rgb> drives = GreysAndPrimaries(kLevels);
  const std::vector<Rgb> once = drives;
  drives.insert(drives.end(), once.begin(), once.end());
  const auto single = FitColour(Measure(truth, once, 0.01, 6), ColourModelKind::kAdditive);
  const auto twice = FitColour(Measure(truth, drives, 0.01, 6), ColourModelKind::kAdditive);
  ASSERT_TRUE(single.ok() && twice.ok());
  EXPECT_LT(twice->parameters[kAdditiveParameters - 1].sigma,
            single->parameters[kAdditiveParameters - 1].sigma);
  // Were one of the two left in, the error could fall below that of the fit itself.
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_GT(twice->leave_one_out_rms_relative[c], twice->rms_relative[c]);
  }
}

TEST(FitColourTest, ChannelWithoutLevelsIsNamed) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  ColourSeries series = Measure(truth, GreysAndPrimaries(kLevels), 0, 1);
  std::erase_if(series.readings, [](const ColourReading& reading) {
    return reading.drive[1] > 0 && reading.drive[0] == 0 && reading.drive[1] < 1;
  });
  const auto choice = ChooseColour(series);
  ASSERT_FALSE(choice.ok());
  EXPECT_EQ(choice.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(choice.status().message().find("green is driven apart"), std::string::npos)
      << choice.status();
}

TEST(FitColourTest, ChannelThatFallsWithItsDriveIsRefused) {
  const ColourModel truth = SyntheticDisplay(ColourModelKind::kAdditive, {});
  ColourSeries series = Measure(truth, GreysAndPrimaries(kLevels), 0, 1);
  for (ColourReading& reading : series.readings) {
    if (reading.drive[2] > 0 && reading.drive[0] == 0) {
      reading.colour[1] = 10 - 9 * reading.drive[2];
    }
  }
  const auto choice = ChooseColour(series);
  ASSERT_FALSE(choice.ok());
  EXPECT_NE(choice.status().message().find("blue alone"), std::string::npos) << choice.status();
}

TEST(FitColourTest, ReadingsThatAreNoneAreNamed) {
  ColourSeries series =
      Measure(SyntheticDisplay(ColourModelKind::kAdditive, {}), GreysAndPrimaries(kLevels), 0, 1);
  series.readings[4].colour[2] = -1;
  const absl::Status status = series.Validate();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("reading 5"), std::string::npos) << status;
  series.readings[4].colour[2] = 1;
  series.readings[2].drive[1] = 1.5;
  EXPECT_NE(series.Validate().message().find("reading 3"), std::string::npos);
  series.readings.clear();
  EXPECT_FALSE(series.Validate().ok());
}

}  // namespace
}  // namespace eyebox::fit
