// `eyebox scatter` as it is typed, and what its result is good for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "eyebox/v1/scatter.pb.h"
#include "tests/service/recorded_rig.h"
#include "tests/service/run_eyebox.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

const v1::Parameter& Named(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters,
                           const std::string& name) {
  for (const v1::Parameter& parameter : parameters) {
    if (parameter.name() == name) return parameter;
  }
  ADD_FAILURE() << "no parameter " << name;
  return v1::Parameter::default_instance();
}

// sim:rift-s-like puts 2 % of the light into a tail; seen once a process.
const std::filesystem::path& RecordedDisks() {
  static const TemporaryFolder folder;
  static const std::filesystem::path recording = Record(folder.path(), "disks",
                                                        {.levels = 2,
                                                         .disk_diameters_deg = {1, 2, 4, 8, 16, 24},
                                                         .black_disk_diameters_deg = {2, 5, 10}});
  return recording;
}

TEST(CliScatter, ARecordingOfDisksTellsWAndItsFigures) {
  const TemporaryFolder folder;
  const auto result = ParsedFrom<v1::ScatterResult>(
      RunEyebox("scatter " + RecordedDisks().string() + " --reach-deg 20.9 --out " +
                (folder / "out").string() + " --json"));
  EXPECT_GT(result.condition_number(), 1);
  const v1::Parameter& share = Named(result.parameters(), "tail_share");
  EXPECT_NEAR(share.value(), 0.02, 4 * share.sigma());
  EXPECT_LT(share.sigma(), 0.01);
  EXPECT_EQ(result.kernel_of(), "headset_and_instrument");
  EXPECT_EQ(result.figures_size(), 4);
  EXPECT_EQ(result.figures(0).name(), "full_field_contrast");
  EXPECT_GT(result.figures(1).value(), 0.003);  // black display over peak alone is 0.0032
  EXPECT_FALSE(result.identifiability().empty());
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "scatter.svg"));

  const std::string kernel = (folder / "out" / "scatter.json").string();
  const auto reduced = ParsedFrom<v1::ReduceResult>(RunEyebox("reduce " + RecordedDisks().string() +
                                                              " --level 1 --scatter " + kernel +
                                                              " --surround continued --json"));
  EXPECT_NEAR(Named(reduced.parameters(), "scatter_removed_share").value(), 0, 0.01);
  EXPECT_GT(Named(reduced.parameters(), "scatter_floor_median").value(), 0);
}

TEST(CliScatter, ReadingsOfAPhotometerAndAReferenceComeApart) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "readings.csv";
  // A disk target of 0.33 deg, a fifth of the light in a tail.
  ASSERT_TRUE(WriteFileAtomically(file,
                                  "diameter_deg,pattern,luminance,sigma\n"
                                  "0.2,disk,18.1,0.1\n0.33,disk,47.0,0.2\n1,disk,48.9,0.2\n"
                                  "3,disk,52.9,0.2\n8,disk,56.2,0.2\n15,disk,57.4,0.2\n"
                                  "40,disk,58.6,0.2\n0,full_field,59,0.2\n0,black,0.19,0.01\n")
                  .ok());
  const Outcome text = RunEyebox("scatter --csv " + file.string() +
                                 " --core disk --background 0.19 --predict 0.33,5");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("patch of     0.33 deg: p = ("));
  EXPECT_THAT(text.err, HasSubstr("--reference"));
}

TEST(CliScatter, WrongInputIsNamed) {
  const Outcome none = RunEyebox("scatter " + RecordedRig().string());
  EXPECT_EQ(none.exit_code, 5);
  EXPECT_THAT(none.err, HasSubstr("no disk"));
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "kernel.json";
  ASSERT_TRUE(WriteFileAtomically(file, R"({"kernel": {"core": "square"}})").ok());
  const Outcome kernel =
      RunEyebox("reduce " + RecordedRig().string() + " --scatter " + file.string());
  EXPECT_EQ(kernel.exit_code, 3);
  EXPECT_THAT(kernel.err, HasSubstr("kernel.core"));
}

}  // namespace
}  // namespace eyebox::service
