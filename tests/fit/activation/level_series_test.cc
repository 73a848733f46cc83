#include "fit/activation/level_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "capture/base/random.h"
#include "tests/fit/activation/simulated_series.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LevelSeries Plausible() { return SimulateSeries({1, 100, 0, 2.2}, 9, 0); }

void ExpectBadInput(const absl::Status& status, const std::string& part) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(part));
}

TEST(LevelSeriesTest, PlausibleSeriesPasses) {
  EXPECT_TRUE(Plausible().Validate().ok());
  EXPECT_FALSE(Plausible().HasSigmas());
  EXPECT_TRUE(SimulateSeries({1, 100, 0, 2.2}, 9, 0.01).HasSigmas());
}

TEST(LevelSeriesTest, ImpossibleReadingIsNamed) {
  for (const double luminance : {-1.0, kNaN, std::numeric_limits<double>::infinity()}) {
    LevelSeries series = Plausible();
    series.readings[3].luminance = luminance;
    ExpectBadInput(series.Validate(), "simulated, reading 4: luminance");
  }
  for (const double drive : {-0.1, 1.1, kNaN}) {
    LevelSeries series = Plausible();
    series.readings[8].drive = drive;
    ExpectBadInput(series.Validate(), "simulated, reading 9: drive value");
  }
  LevelSeries series = Plausible();
  series.readings[0].luminance_sigma = -1;
  ExpectBadInput(series.Validate(), "simulated, reading 1: sigma");
}

TEST(LevelSeriesTest, DrivesOutOfOrderAreRejected) {
  LevelSeries series = Plausible();
  std::swap(series.readings[2], series.readings[3]);
  ExpectBadInput(series.Validate(), "sort the readings");
}

TEST(LevelSeriesTest, FlatLineIsRejected) {
  LevelSeries series = Plausible();
  for (LevelReading& reading : series.readings) reading.luminance = 80;
  ExpectBadInput(series.Validate(), "simulated: the luminance does not rise");
  for (LevelReading& reading : series.readings) reading.luminance = 0;
  ExpectBadInput(series.Validate(), "does not rise");
}

TEST(LevelSeriesTest, FallingSeriesIsRejected) {
  LevelSeries series = Plausible();
  for (LevelReading& reading : series.readings) reading.luminance = 100 * (1 - reading.drive);
  ExpectBadInput(series.Validate(), "does not rise");
}

TEST(LevelSeriesTest, NoiseIsRejected) {
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random({seed});
    LevelSeries series = SimulateSeries({1, 100, 0, 2.2}, 17, 0);
    for (LevelReading& reading : series.readings) reading.luminance = 50 + 10 * random.Uniform();
    EXPECT_FALSE(series.Validate().ok()) << "seed " << seed;
  }
}

TEST(LevelSeriesTest, NoisyDarkHalfPasses) {
  RandomStream random({3});
  LevelSeries series = SimulateSeries({0.1, 100, 0.5, 2.2}, 17, 0);
  for (LevelReading& reading : series.readings) reading.luminance += 0.02 * random.Uniform();
  EXPECT_TRUE(series.Validate().ok());
}

TEST(LevelSeriesTest, OneLevelOrThreeAreTooFew) {
  LevelSeries series = Plausible();
  series.readings.assign(10, {0.5, 20, 0});
  ExpectBadInput(series.Validate(), "1 different drive values");
  series.readings = {{0, 1, 0}, {0.5, 20, 0}, {0.5, 21, 0}, {1, 100, 0}};
  ExpectBadInput(series.Validate(), "3 different drive values");
  series.readings.clear();
  ExpectBadInput(series.Validate(), "0 different drive values");
}

class LevelSeriesCsvTest : public ::testing::Test {
 protected:
  absl::StatusOr<LevelSeries> Read(const std::string& text) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "level_series.csv";
    std::ofstream(file) << text;
    return ReadLevelSeriesCsv(file);
  }
};

TEST_F(LevelSeriesCsvTest, RowsOfAnyOrderAreSorted) {
  const auto series = Read("lum,m_k\n100,1\n1,0\n20,0.5\n5,0.25\n60,0.75\n");
  ASSERT_TRUE(series.ok()) << series.status();
  ASSERT_EQ(series->readings.size(), 5U);
  EXPECT_EQ(series->readings[1].drive, 0.25);
  EXPECT_EQ(series->readings[1].luminance, 5);
  EXPECT_EQ(series->luminance_unit, "cd/m2");
  EXPECT_FALSE(series->HasSigmas());
}

TEST_F(LevelSeriesCsvTest, SigmasAreRead) {
  const auto series = Read("m_k,lum,lum_sigma\n0,1,0.1\n0.3,9,0.2\n0.6,40,0.3\n1,100,0.4\n");
  ASSERT_TRUE(series.ok()) << series.status();
  EXPECT_TRUE(series->HasSigmas());
  EXPECT_EQ(series->readings[2].luminance_sigma, 0.3);
}

TEST_F(LevelSeriesCsvTest, BadFieldIsNamedByLineAndColumn) {
  ExpectBadInput(Read("m_k,lum\n0,1\n0.3,x\n0.6,40\n1,100\n").status(),
                 "level_series.csv:3, column lum");
  ExpectBadInput(Read("m_k,lum\n0,1\n0.3,9\n0.6,-40\n1,100\n").status(),
                 "level_series.csv:4, column lum");
  ExpectBadInput(Read("m_k,lum\n0,1\n0.3,9\n0.6,40\n255,100\n").status(),
                 "level_series.csv:5, column m_k");
  ExpectBadInput(Read("m_k,lum\n0,1\n0.3,nan\n0.6,40\n1,100\n").status(), "column lum");
  ExpectBadInput(Read("drive,lum\n0,1\n").status(), "m_k");
}

TEST_F(LevelSeriesCsvTest, FlatLineInAFileIsBadInput) {
  ExpectBadInput(Read("m_k,lum\n0,80\n0.3,80\n0.6,80\n1,80\n").status(), "level_series.csv");
}

TEST_F(LevelSeriesCsvTest, AbsentFileIsNotFound) {
  EXPECT_EQ(ReadLevelSeriesCsv("absent.csv").status().code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace eyebox::fit
