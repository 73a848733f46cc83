#include "fit/renderer/delta_sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "fit/renderer/known_knots.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

RecoveredKnots Recovered(const SweepOptions& options) {
  const auto sweep = SimulateDeltaSweep(options);
  EXPECT_TRUE(sweep.ok()) << sweep.status();
  const auto knots = RecoverKnots(*sweep);
  EXPECT_TRUE(knots.ok()) << knots.status();
  return *knots;
}

TEST(DeltaSweepTest, RecoversTheTableThatWasSimulated) {
  const RecoveredKnots recovered = Recovered({});
  const std::vector<double> analytic = AnalyticKnots(32);
  for (int i = 3; i < 32; ++i) {
    const RecoveredKnot& knot = recovered.knots[i];
    ASSERT_TRUE(knot.is_found) << i;
    EXPECT_NEAR(knot.u_optimised / analytic[i], 1, 1e-3) << i;
    EXPECT_NEAR(knot.u_at_peak / analytic[i], 1, 0.02) << i;
    EXPECT_GT(knot.sigma, 0) << i;
  }
}

TEST(DeltaSweepTest, RecoveredKnotsAreThePublishedOnesWithinTwoPercent) {
  const RecoveredKnots recovered = Recovered({});
  for (int i = 3; i < 32; ++i) {
    EXPECT_NEAR(recovered.knots[i].u_optimised / KnotsFromDeltas()[i - 2], 1, 0.02) << i;
  }
}

// u = 0 lands at 1.985, so no light reaches the first two entries.
TEST(DeltaSweepTest, TheFirstTwoEntriesNeverMatter) {
  const RecoveredKnots recovered = Recovered({});
  EXPECT_FALSE(recovered.knots[0].is_found);
  EXPECT_FALSE(recovered.knots[1].is_found);
  EXPECT_THAT(recovered.knots[0].why_not, HasSubstr("no u is mapped to it"));
  EXPECT_TRUE(recovered.knots[2].is_found);
  EXPECT_LT(AnalyticKnots(32)[1], 0);
  EXPECT_GT(AnalyticKnots(32)[2], 0);
}

TEST(DeltaSweepTest, TruncatedBuffersShiftTheKnotsByLessThanAStep) {
  SweepOptions options;
  options.packed_buffers = true;
  const RecoveredKnots recovered = Recovered(options);
  const std::vector<double> analytic = AnalyticKnots(32);
  for (int i = 3; i < 32; ++i) {
    EXPECT_NEAR(recovered.knots[i].u_optimised / analytic[i], 1 + 1.0 / 128, 1.0 / 100) << i;
  }
}

TEST(DeltaSweepTest, OptimisedKnotsAscendAlsoInACoarseSweep) {
  SweepOptions options;
  options.steps = 150;
  const RecoveredKnots recovered = Recovered(options);
  for (int i = 3; i < 32; ++i) {
    EXPECT_GT(recovered.knots[i].u_optimised, recovered.knots[i - 1].u_optimised);
  }
}

TEST(DeltaSweepTest, SweepsThatFixNothingAreRefused) {
  DeltaSweep dark{4, {}};
  for (int cube = 1; cube <= 4; ++cube) {
    for (int i = 0; i < 5; ++i) dark.readings.push_back({cube, 0.1 * i, 0});
  }
  EXPECT_EQ(RecoverKnots(dark).status().code(), absl::StatusCode::kFailedPrecondition);
  dark.readings.resize(12);
  EXPECT_EQ(RecoverKnots(dark).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_FALSE(SimulateDeltaSweep({.size = 3}).ok());
  EXPECT_FALSE(SimulateDeltaSweep({.u_from = 0}).ok());
}

TEST(DeltaSweepTest, CsvReadsBackAndNamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto sweep = SimulateDeltaSweep({.size = 4, .steps = 5});
  std::ofstream(folder / "sweep.csv") << EncodeDeltaSweep(*sweep);
  const auto back = ReadDeltaSweep(folder / "sweep.csv", 4);
  ASSERT_TRUE(back.ok()) << back.status();
  ASSERT_EQ(back->readings.size(), sweep->readings.size());
  EXPECT_NEAR(back->readings[7].t, sweep->readings[7].t, 1e-8);
  std::ofstream(folder / "bad.csv") << "cube,u,t\n1,0,0\n5,0,0\n";
  EXPECT_THAT(std::string(ReadDeltaSweep(folder / "bad.csv", 4).status().message()),
              HasSubstr("bad.csv:3, column cube"));
}

}  // namespace
}  // namespace eyebox::fit
