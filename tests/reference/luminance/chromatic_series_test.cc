// A headset's colour series: what the chosen model predicts of stimuli it has not seen.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "fit/color/fit_colour.h"

namespace eyebox::fit {
namespace {

std::filesystem::path ReferenceFile(const char* name) {
  return std::filesystem::path(EYEBOX_SOURCE_DIR) / "../shared/reference/luminance" / name;
}

class ChromaticSeriesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file = ReferenceFile("chromatic_118.csv");
    if (!std::filesystem::exists(file)) {
      GTEST_SKIP() << file << " is absent: no real series to fit";
    }
    const auto series = ReadColourSeriesCsv(file);
    ASSERT_TRUE(series.ok()) << series.status();
    series_ = *series;
  }

  ColourSeries series_;
};

void Print(const ColourFit& fit) {
  const Xyz& rms = fit.rms_relative;
  const Xyz& left_out = fit.leave_one_out_rms_relative;
  std::printf(
      "%-18s %2d parameters: rms %.2f %.2f %.2f %%, leave-one-out %.2f %.2f %.2f %% "
      "(X Y Z), AICc %.1f; %s\n",
      NameOf(fit.model.kind).data(), ParameterCount(fit.model.kind), 100 * rms[0], 100 * rms[1],
      100 * rms[2], 100 * left_out[0], 100 * left_out[1], 100 * left_out[2], fit.aicc,
      fit.termination.c_str());
}

TEST_F(ChromaticSeriesTest, ChosenModelPredictsEveryStimulusLeftOut) {
  const auto choice = ChooseColour(series_);
  ASSERT_TRUE(choice.ok()) << choice.status();
  for (const ColourFit& fit : choice->tried) Print(fit);
  for (const Parameter& parameter : choice->best.parameters) {
    std::printf("  %s = %.5f +- %.5f %s\n", parameter.name.c_str(), parameter.value,
                parameter.sigma, parameter.unit.c_str());
  }
  std::printf("%s\n%s\n", choice->reason.c_str(), choice->verdict.c_str());
  EXPECT_EQ(choice->best.model.kind, ColourModelKind::kDriveCrosstalk);
  EXPECT_LE(choice->best.leave_one_out_rms_relative[0], 0.03);
  EXPECT_LE(choice->best.leave_one_out_rms_relative[1], 0.02);
  EXPECT_LE(choice->best.leave_one_out_rms_relative[2], 0.03);
  EXPECT_TRUE(choice->certified) << choice->verdict;
}

TEST_F(ChromaticSeriesTest, AdditivityFailsAsPublishedFiguresSay) {
  const AdditivityTest test = TestAdditivity(series_);
  std::printf("%s\n", test.verdict.c_str());
  for (const AdditivityLevel& level : test.levels) {
    std::printf("  %.1f: %+.1f %+.1f %+.1f %%\n", level.drive, 100 * level.departure[0],
                100 * level.departure[1], 100 * level.departure[2]);
  }
  EXPECT_FALSE(test.passed);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_LT(test.mean_departure[c], -0.09);
    EXPECT_GT(test.mean_departure[c], -0.25);
  }
}

TEST_F(ChromaticSeriesTest, ChannelsKeepTheirChromaticity) {
  const auto tests = TestConstancy(series_);
  for (size_t k = 0; k < 3; ++k) {
    std::printf("%s: at most %.4f u'v' at drive %.1f, rms %.4f\n", kChannelNames[k],
                tests[k].max_distance, tests[k].at_drive, tests[k].rms_distance);
    EXPECT_TRUE(tests[k].passed);
  }
}

}  // namespace
}  // namespace eyebox::fit
