// Colour from a series of readings to a table, as a person would do it.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "eyebox/v1/color.pb.h"
#include "fit/cube/table_file.h"
#include "service/results/colour.h"
#include "tests/fit/color/synthetic_display.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

fit::ColourSeries CrosstalkSeries() {
  const fit::ColourModel display =
      fit::SyntheticDisplay(fit::ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.045});
  return fit::Measure(display, fit::GreysAndPrimaries(8), 0.003, 3);
}

class CliColourTest : public ::testing::Test {
 protected:
  void SetUp() override {
    csv_ = folder_ / "colours.csv";
    std::ofstream file(csv_);
    file << "m_r,m_g,m_b,x,y,z\n";
    file.precision(17);
    for (const fit::ColourReading& reading : CrosstalkSeries().readings) {
      const auto& [r, g, b] = reading.drive;
      const auto& [x, y, z] = reading.colour;
      file << r << "," << g << "," << b << "," << x << "," << y << "," << z << "\n";
    }
  }

  // The fit as a file for `eyebox cube`.
  std::string WriteFit() {
    const std::string file = folder_ / "fit.json";
    const Outcome outcome = RunEyebox("fit --csv " + csv_ + " --json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::ofstream(file) << outcome.out;
    return file;
  }

  TemporaryFolder folder_;
  std::string csv_;
};

TEST_F(CliColourTest, FitPrintsVerdictsAndWhatATableNeeds) {
  const auto result = ParsedFrom<v1::ColourResult>(RunEyebox("fit --csv " + csv_ + " --json"));
  EXPECT_EQ(result.model(), "drive_crosstalk");
  EXPECT_TRUE(result.colour_certified()) << result.verdict();
  EXPECT_FALSE(result.additivity().passed());
  EXPECT_LT(result.leave_one_out_rms_relative().y(), 0.02);
  EXPECT_GT(result.leave_one_out_rms_relative().y(), 0);
  EXPECT_GT(result.condition_number(), 1);
  EXPECT_EQ(result.parameters_size(), 21);
  EXPECT_EQ(result.stimuli_size(), 33);
  EXPECT_EQ(result.warnings_size(), 1);  // no mixtures

  const Outcome table = RunEyebox("fit --csv " + csv_);
  EXPECT_EQ(table.exit_code, 0) << table.err;
  for (const char* part : {"additivity fails", "leave-one-out", "crosstalk_r", "certified"}) {
    EXPECT_NE(table.out.find(part), std::string::npos) << part << "\n" << table.out;
  }
}

TEST_F(CliColourTest, CubeOfEachTargetIsWrittenAndCertified) {
  const std::string fit = WriteFit();
  const std::string cube = folder_ / "colour.cube";
  const auto result = ParsedFrom<v1::ColourCubeResult>(RunEyebox(
      "cube --fit " + fit + " --target hdrp --size 32 --gamut srgb --out " + cube + " --json"));
  EXPECT_EQ(result.ramps_size(), 4);
  EXPECT_LT(result.certificate().max_relative(), 0.01);
  EXPECT_EQ(result.gamut(), "srgb");
  EXPECT_LT(result.parameters(2).value(), 1);
  const auto read = fit::ReadCube(cube);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->size, 32);

  const std::string strip = folder_ / "colour.png";
  EXPECT_EQ(
      RunEyebox("cube --target pps --size 16 --scale white --out " + strip + " --fit - < " + fit)
          .exit_code,
      0);
  EXPECT_TRUE(fit::ReadStrip(strip).ok());
  const Outcome resolve = RunEyebox("cube --fit " + fit + " --target resolve --size 17 --out " +
                                    cube + " --white-point 0.3127,0.3290");
  EXPECT_EQ(resolve.exit_code, 0) << resolve.err;
  EXPECT_NE(resolve.out.find("bright enough up to"), std::string::npos) << resolve.out;
}

TEST_F(CliColourTest, BadRequestsSayWhatToDo) {
  const std::string fit = WriteFit();
  const std::string out = folder_ / "no.cube";
  EXPECT_EQ(RunEyebox("fit --csv " + csv_ + " --model power_offset").exit_code, 3);
  EXPECT_EQ(RunEyebox("cube --fit " + fit + " --target hdrp --gamut none --out " + out).exit_code,
            2);
  const Outcome white = RunEyebox("cube --fit " + fit + " --target hdrp --gamut srgb " +
                                  "--white-point 0.7,0.29 --out " + out);
  EXPECT_EQ(white.exit_code, 3) << white.err;
  EXPECT_NE(white.err.find("outside the triangle"), std::string::npos) << white.err;
  std::ofstream(csv_) << "m_r,m_g,m_b,x,y\n0,0,0,1,1\n";
  const Outcome column = RunEyebox("fit --csv " + csv_);
  EXPECT_EQ(column.exit_code, 3);
  EXPECT_NE(column.err.find("z"), std::string::npos) << column.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(ColourResultTest, ModelComesBackToTheBit) {
  const auto choice = fit::ChooseColour(CrosstalkSeries());
  ASSERT_TRUE(choice.ok()) << choice.status();
  const auto json = ToJson(DescribeColour(*choice));
  ASSERT_TRUE(json.ok());
  v1::ColourResult result;
  ASSERT_TRUE(ParseJson(*json, "test", result).ok());
  const auto model = ColourModelOf(result, "test");
  ASSERT_TRUE(model.ok()) << model.status();
  EXPECT_EQ(model->ToParameters(), choice->best.model.ToParameters());

  result.mutable_parameters(4)->set_value(-2);
  EXPECT_NE(ColourModelOf(result, "here").status().message().find("here: parameter gamma_g"),
            std::string::npos);
  result.mutable_parameters()->RemoveLast();
  EXPECT_NE(ColourModelOf(result, "here").status().message().find("crosstalk_b"),
            std::string::npos);
  result.set_model("magic");
  EXPECT_FALSE(ColourModelOf(result, "here").ok());
}

}  // namespace
}  // namespace eyebox::service
