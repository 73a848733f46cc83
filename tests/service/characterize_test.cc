// The characterize command, on files as a person has them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "eyebox/v1/characterize.pb.h"
#include "eyebox/v1/results.pb.h"
#include "service/results/characterize.h"
#include "tests/optics/emva1288/camera.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

const char kFixture[] = EYEBOX_SOURCE_DIR "/fixtures/rift-s-like-seed1";
constexpr ImageSize kSize{128, 96};

v1::Parameter Find(const v1::CharacterizeResult& result, const std::string& name) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == name) return parameter;
  }
  ADD_FAILURE() << "no parameter " << name;
  return {};
}

double Value(const v1::CharacterizeResult& result, const std::string& name) {
  return Find(result, name).value();
}

double Sigma(const v1::CharacterizeResult& result, const std::string& name) {
  return Find(result, name).sigma();
}

class CharacterizeTest : public testing::Test {
 protected:
  std::string WriteDescriptor() {
    optics::Emva1288Camera camera(truth_, kSize, 31);
    camera.response.at(30, 40) = 0;
    return optics::WriteSeries(folder_ / "series", camera).string();
  }

  optics::Emva1288CameraTruth truth_;
  TemporaryFolder folder_;
};

TEST_F(CharacterizeTest, DescriptorGivesTheStandardsNamesAndASensorThatReadsBack) {
  const std::string out = folder_ / "sensor";
  const auto result = ParsedFrom<v1::CharacterizeResult>(
      RunEyebox("characterize --emva1288 " + WriteDescriptor() + " --out " + out + " --json"));
  EXPECT_NEAR(Value(result, "K"), truth_.gain_dn_per_e, 0.02 * truth_.gain_dn_per_e);
  EXPECT_NEAR(Value(result, "eta"), truth_.quantum_efficiency, 0.02);
  EXPECT_NEAR(Value(result, "sigma_d"), truth_.dark_noise_e, 0.5);
  EXPECT_NEAR(Value(result, "DSNU1288"), truth_.dsnu_e, 1);
  EXPECT_GT(Value(result, "DR_dB"), 79);
  EXPECT_LT(Value(result, "LE"), 1e-4);
  EXPECT_EQ(result.irradiation_unit(), "photon");
  EXPECT_TRUE(result.saturation_reached());
  EXPECT_EQ(result.steps_size(), 64);
  EXPECT_EQ(result.defective_pixels(), 1);
  EXPECT_THAT(result.release(), HasSubstr("EMVA 1288 release 4.0"));

  const auto sensor = ReadSensor(out);
  ASSERT_TRUE(sensor.ok()) << sensor.status();
  optics::Calibration calibration;
  calibration.defects.defective = Image<uint8_t>(kSize);
  ASSERT_TRUE(optics::ApplySensor(*sensor, calibration).ok());
  EXPECT_DOUBLE_EQ(calibration.noise.gain_dn_per_e, Value(result, "K"));
  EXPECT_NEAR(calibration.noise.read_variance_dn2, 1.6 * 1.6, 0.1);
  EXPECT_EQ(calibration.defects.defective.at(30, 40), 1);
  ASSERT_TRUE(calibration.linearity.has_value());
  EXPECT_NEAR(calibration.linearity->At(5000).value_dn, 5000, 10);
}

TEST_F(CharacterizeTest, SummaryIsAscii) {
  const Outcome outcome = RunEyebox("characterize --emva1288 " + WriteDescriptor());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("PRNU1288"));
  EXPECT_THAT(outcome.out, HasSubstr("|####"));
  for (const char letter : outcome.out) ASSERT_LT(static_cast<unsigned char>(letter), 128);
}

TEST_F(CharacterizeTest, SensorFilesThatWereChangedAreRefused) {
  const std::string out = folder_ / "sensor";
  ASSERT_EQ(RunEyebox("characterize --emva1288 " + WriteDescriptor() + " --out " + out).exit_code,
            0);
  std::fstream(out + "/defects.npy", std::ios::in | std::ios::out | std::ios::ate) << "x";
  const auto sensor = ReadSensor(out);
  EXPECT_EQ(sensor.status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(sensor.status().message(), HasSubstr("defects.npy"));
  EXPECT_EQ(ReadSensor(folder_ / "absent").status().code(), absl::StatusCode::kNotFound);
}

TEST_F(CharacterizeTest, RecordingGivesGainAndNoiseOfItsCamera) {
  const auto result = ParsedFrom<v1::CharacterizeResult>(
      RunEyebox("characterize " + std::string(kFixture) + " --json"));
  // What its truth.json says, within three of the stated sigmas, which are small.
  const auto expect = [&](const std::string& name, double truth, double largest_sigma) {
    EXPECT_NEAR(Value(result, name), truth, 3 * Sigma(result, name)) << name;
    EXPECT_LT(Sigma(result, name), largest_sigma * truth) << name;
  };
  expect("K", 0.2, 0.03);
  expect("full_well", 20500, 0.03);
  expect("sigma_d", 3, 0.05);
  EXPECT_EQ(result.irradiation_unit(), "DN");
  EXPECT_GT(result.steps_size(), 10);
  EXPECT_GT(result.region_width_px(), 0);
}

TEST_F(CharacterizeTest, BadDescriptorNamesItsLineAndEndsWithThree) {
  std::ofstream(folder_ / "bad.txt") << "v 3.0\nn 12 10 10\nb 5\n";
  const Outcome outcome = RunEyebox("characterize --emva1288 " + (folder_ / "bad.txt").string());
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("bad.txt:3"));
  EXPECT_TRUE(outcome.out.empty());
}

TEST_F(CharacterizeTest, NeitherSourceNorBothIsAccepted) {
  EXPECT_NE(RunEyebox("characterize").exit_code, 0);
  EXPECT_EQ(RunEyebox("characterize rec --emva1288 d.txt").exit_code, 2);
}

// The fixture's own characterisation is a sensor part for it.
TEST_F(CharacterizeTest, ReducingWithTheSensorTakesGainAndDefectsFromIt) {
  const std::string out = folder_ / "sensor";
  const auto sensor = ParsedFrom<v1::CharacterizeResult>(
      RunEyebox("characterize " + std::string(kFixture) + " --out " + out + " --json"));
  EXPECT_EQ(sensor.camera_model(), "simulator");
  const auto reduced = ParsedFrom<v1::ReduceResult>(
      RunEyebox("reduce " + std::string(kFixture) + " --sensor " + out + " --json"));
  EXPECT_THAT(reduced.noise_source(), HasSubstr("EMVA 1288"));
  for (const v1::Parameter& parameter : reduced.parameters()) {
    if (parameter.name() != "system_gain") continue;
    EXPECT_EQ(parameter.value(), Value(sensor, "K"));
  }
  const auto estimated =
      ParsedFrom<v1::ReduceResult>(RunEyebox("reduce " + std::string(kFixture) + " --json"));
  EXPECT_EQ(estimated.noise_source().find("EMVA 1288"), std::string::npos);
}

TEST_F(CharacterizeTest, SensorOfAnotherCameraIsRefusedByName) {
  const std::string out = folder_ / "sensor";
  ASSERT_EQ(RunEyebox("characterize --emva1288 " + WriteDescriptor() + " --out " + out).exit_code,
            0);
  const Outcome outcome = RunEyebox("reduce " + std::string(kFixture) + " --sensor " + out);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr(out));
  EXPECT_THAT(outcome.err, HasSubstr("it was characterised with"));
}

TEST_F(CharacterizeTest, RigKeepsItsSensorWithTheRecording) {
  const std::string out = folder_ / "sensor";
  ASSERT_EQ(RunEyebox("characterize " + std::string(kFixture) + " --out " + out).exit_code, 0);
  std::ofstream(folder_ / "rig.textproto")
      << "name: \"lab\" camera_uri: \"sim:rift-s-like\" seed: 3 sensor: \"sensor\"\n";
  const std::string recording = folder_ / "recording";
  const Outcome captured =
      RunEyebox("capture " + std::string(folder_ / "rig.textproto") + " --out " + recording);
  ASSERT_EQ(captured.exit_code, 0) << captured.err;
  EXPECT_TRUE(std::filesystem::exists(recording + "/sensor/sensor.json"));
  std::filesystem::remove_all(out);  // the copy is enough
  const auto reduced = ParsedFrom<v1::ReduceResult>(RunEyebox("reduce " + recording + " --json"));
  EXPECT_THAT(reduced.noise_source(), HasSubstr("EMVA 1288"));
}

}  // namespace
}  // namespace eyebox::service
