// Readings of a spot photometer from a table, and what such an instrument will read.
#include "fit/scatter/glare_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "capture/base/file.h"
#include "fit/scatter/predict_readings.h"
#include "optics/scatter/spot_photometer.h"
#include "tests/fit/scatter/simulated_glare.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

absl::StatusOr<GlareTable> Read(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder / "readings.csv";
  EXPECT_TRUE(WriteFileAtomically(file, text).ok());
  return ReadGlareCsv(file, 50);
}

constexpr const char* kTable =
    "pattern,diameter_deg,luminance,sigma\n"
    "disk,0.5,20,0.1\nblack_disk,2,1.5,0.02\nfull_field,,59,0.3\nblack,,0.19,0.01\n";

TEST(GlareCsv, EveryPatternBecomesADisk) {
  const auto table = Read(kTable);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_THAT(table->warnings, IsEmpty());
  const auto& readings = table->series.readings;
  ASSERT_EQ(readings.size(), 4);
  EXPECT_EQ(readings[0].diameter_deg, 0.5);
  EXPECT_EQ(readings[1].pattern, GlarePattern::kBlackDisk);
  EXPECT_EQ(readings[1].luminance_sigma, 0.02);
  EXPECT_EQ(readings[2].pattern, GlarePattern::kBlackDisk);  // bright, without a hole
  EXPECT_EQ(readings[2].diameter_deg, 0);
  EXPECT_EQ(readings[3].pattern, GlarePattern::kBrightDisk);
}

TEST(GlareCsv, AssumedSigmasAreSaid) {
  const auto table = Read(
      "diameter_deg,pattern,luminance\n1,disk,50\n2,disk,55\n3,disk,57\n"
      "0,black,0.001\n");
  ASSERT_TRUE(table.ok()) << table.status();
  ASSERT_EQ(table->warnings.size(), 1);
  EXPECT_THAT(table->warnings[0], HasSubstr("sigma"));
  EXPECT_DOUBLE_EQ(table->series.readings[0].luminance_sigma, 0.5);
  EXPECT_DOUBLE_EQ(table->series.readings[3].luminance_sigma, 0.01 * 0.057);
}

TEST(GlareCsv, WhatIsWrongIsNamedByLineAndColumn) {
  const auto message = [](const std::string& row) {
    return std::string(
        Read("diameter_deg,pattern,luminance,sigma\n1,disk,5,1\n" + row).status().message());
  };
  EXPECT_THAT(message("2,ring,5,1\n"), HasSubstr(":3, column pattern"));
  EXPECT_THAT(message("0,disk,5,1\n"), HasSubstr(":3, column diameter_deg"));
  EXPECT_THAT(message("2,disk,5,0\n"), HasSubstr(":3, column sigma"));
  EXPECT_THAT(message("2,disk,,1\n"), HasSubstr(":3, column luminance"));
  EXPECT_THAT(message("2,disk,5,1\n"), HasSubstr("2 glare readings"));
}

// Murray, Patel & Wiedenmann 2022, fig 6 and eq 5 to 9: a disk as large as the target reads far
// too little, and only the whole field is proportional to what it shows.
TEST(PredictReadings, OnlyTheWholeFieldIsProportional) {
  const optics::ScatterKernel spot{.core = optics::CoreShape::kDisk,
                                   .core_radius_deg = 0.165,
                                   .tail_share = 0.25,
                                   .tail_radius_deg = 1.5,
                                   .tail_exponent = 2.6};
  ScatterFitOptions options;
  options.core = optics::CoreShape::kDisk;
  const GlareSeries series = SimulateGlare(spot, {}, 3);
  const auto fit = FitScatter(series, options);
  ASSERT_TRUE(fit.ok()) << fit.status();
  const std::vector<double> diameters = {0.33, 1, 5, 15, 40};
  const auto predicted = PredictReadings(*fit, options, series.field_radius_deg, diameters);
  ASSERT_TRUE(predicted.ok()) << predicted.status();
  ASSERT_EQ(predicted->size(), 6);
  for (size_t i = 0; i < predicted->size(); ++i) {
    const PredictedReading& reading = (*predicted)[i];
    const auto truth =
        optics::ReadDisk({spot, 0.33}, {reading.diameter_deg, 59, 0.19, series.field_radius_deg});
    EXPECT_NEAR(reading.reading, *truth, 4 * reading.reading_sigma) << reading.diameter_deg;
    EXPECT_LT(reading.reading_sigma, 0.01 * reading.reading);
    if (i > 0) {
      EXPECT_GT(reading.slope, (*predicted)[i - 1].slope);
      EXPECT_LT(reading.offset, (*predicted)[i - 1].offset);
    }
  }
  EXPECT_LT(predicted->front().slope, 0.8);
  EXPECT_GT(predicted->front().offset, 3 * predicted->front().offset_sigma);
  EXPECT_NEAR(predicted->back().offset, 0, 1e-12);
  EXPECT_TRUE(absl::IsInvalidArgument(
      PredictReadings(*fit, options, 50, std::vector<double>{0.0}).status()));
}

}  // namespace
}  // namespace eyebox::fit
