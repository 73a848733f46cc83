// `eyebox photometry` as it is typed, and what its result is good for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "eyebox/v1/photometry.pb.h"
#include "service/steps/known_scale.h"
#include "tests/service/recorded_rig.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

std::string Write(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file) << content;
  return file.string();
}

// 2e-4 cd/m2 per DN/s and `offset_dn_s` of stray light.
std::string Lights(double offset_dn_s) {
  std::string csv = "luminance_cd_m2,luminance_sigma_cd_m2,reading_dn_s\n";
  for (const double luminance : {1.0, 5.0, 20.0, 80.0, 150.0}) {
    csv += std::to_string(luminance) + "," + std::to_string(0.003 * luminance) + "," +
           std::to_string(luminance / 2e-4 + offset_dn_s) + "\n";
  }
  return csv;
}

TEST(CliPhotometry, AScaleFromKnownLuminancesIsTheLuminanceOfADnPerSecond) {
  const TemporaryFolder folder;
  const std::string csv = Write(folder / "flat.csv", Lights(0));
  const std::string file = (folder / "scale.json").string();
  const auto result = ParsedFrom<v1::PhotometryResult>(
      RunEyebox("photometry scale " + csv + " --meter-sigma 0.02 --json --out " + file));
  EXPECT_TRUE(result.accepted());
  EXPECT_NEAR(result.parameters(0).value(), 2e-4, 1e-9);
  EXPECT_NEAR(result.luminance().relative_sigma(), 0.02, 1e-3);

  optics::Calibration calibration;
  ASSERT_TRUE(UseScale(file, calibration).ok());
  EXPECT_NEAR(calibration.luminance_of_one_dn_per_s->luminance_cd_m2, 2e-4, 1e-9);
  EXPECT_EQ(calibration.luminance_of_one_dn_per_s->relative_sigma,
            result.luminance().relative_sigma());

  // The flat of the simulator has a known luminance.
  const Outcome twice = RunEyebox("reduce " + RecordedRig().string() + " --scale " + file);
  EXPECT_EQ(twice.exit_code, 5);
  EXPECT_THAT(twice.err, HasSubstr("flat has a known luminance"));
}

TEST(CliPhotometry, AnInterceptIsRefused) {
  const TemporaryFolder folder;
  const std::string csv = Write(folder / "flat.csv", Lights(3000));
  const std::string file = (folder / "scale.json").string();
  const Outcome outcome = RunEyebox("photometry scale " + csv + " --out " + file);
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("does not go through the origin"));
  optics::Calibration calibration;
  EXPECT_THAT(UseScale(file, calibration).message(), HasSubstr("was not accepted"));
  EXPECT_FALSE(calibration.luminance_of_one_dn_per_s.has_value());
}

TEST(CliPhotometry, APhotodiodeHasACurve) {
  const TemporaryFolder folder;
  std::string csv = "luminance_cd_m2,counts\n";
  for (double luminance = 0.01; luminance < 1e4; luminance *= 3) {
    csv += std::to_string(luminance) + "," + std::to_string(7 * std::pow(luminance, 0.8)) + "\n";
  }
  const auto result = ParsedFrom<v1::PhotometryResult>(RunEyebox(
      "photometry photodiode " + Write(folder / "diode.csv", csv) + " --meter-sigma 0.03 --json"));
  EXPECT_EQ(result.photodiode().axes(), "log_log");
  EXPECT_NEAR(result.photodiode().relative_sigma(), 0.03, 1e-3);
  EXPECT_EQ(result.photodiode().counts_size(), 13);
}

TEST(CliPhotometry, MismatchAndColourComeFromTables) {
  const TemporaryFolder folder;
  const auto mismatch = ParsedFrom<v1::PhotometryResult>(RunEyebox(
      "photometry mismatch " +
      Write(folder / "spectra.csv",
            "wavelength_nm,responsivity,red,red_sigma\n380,0,0,0\n500,0.5,0,0\n560,1,0,0\n"
            "600,0.8,0.1,0.01\n630,0.7,1,0.02\n660,0.5,0.1,0.01\n780,0,0,0\n") +
      " --json"));
  ASSERT_EQ(mismatch.mismatch().corrections_size(), 1);
  EXPECT_EQ(mismatch.mismatch().calibration_light(), "CIE illuminant A");
  EXPECT_LT(mismatch.mismatch().corrections(0).factor(), 1);  // it sees more red than the eye
  EXPECT_GT(mismatch.mismatch().corrections(0).sigma(), 0);

  const std::string colours =
      Write(folder / "colours.csv",
            "signal_r,signal_g,signal_b,x,y,z\n100,5,1,40,21,2\n4,100,6,36,72,11\n2,8,100,18,7,95\n"
            "104,110,105,94,100,108\n50,55,50,47,50,54\n20,90,60,50,80,70\n");
  const auto colour =
      ParsedFrom<v1::PhotometryResult>(RunEyebox("photometry colour " + colours + " --json"));
  EXPECT_GT(colour.colour().condition_number(), 1);
  EXPECT_EQ(colour.colour().unit(), "relative");
  EXPECT_EQ(colour.colour().matrix_size(), 3 * colour.colour().columns());
  const Outcome column = RunEyebox("photometry scale " + colours);
  EXPECT_EQ(column.exit_code, 3);
  EXPECT_THAT(column.err, HasSubstr("luminance_cd_m2"));
}

}  // namespace
}  // namespace eyebox::service
