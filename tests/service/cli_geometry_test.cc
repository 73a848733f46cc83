// `eyebox geometry` as it is typed, and what its result is good for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "capture/base/npy.h"
#include "eyebox/v1/geometry.pb.h"
#include "tests/optics/geometry/photograph.h"
#include "tests/service/recorded_rig.h"
#include "tests/service/run_eyebox.h"
#include "tests/support/grey_image.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

// The lens of sim:rift-s-like.
optics::CameraModel SimLens() {
  return optics::IdealPinhole(
      {.focal_length_px = 219.8, .principal_x_px = 79.5, .principal_y_px = 59.5}, {160, 120});
}

constexpr int kColumns = 7;
constexpr int kRows = 5;

double Dots(double x_mm, double y_mm) {
  return optics::GridOfDots(kColumns, kRows, 8, 2, x_mm, y_mm);
}

void WriteView(const std::filesystem::path& file, const optics::Pose& pose, unsigned seed) {
  const Image<double> view = optics::Photograph(SimLens(), pose, seed, 5, Dots);
  Image<uint16_t> counts(view.size());
  for (size_t i = 0; i < counts.pixels().size(); ++i) {
    counts.pixels()[i] = static_cast<uint16_t>(std::lround(view.pixels()[i]));
  }
  WriteGreyTiff(file, counts, 16);
}

// Views of bright dots, made once a process.
const std::filesystem::path& Views() {
  static const TemporaryFolder folder;
  static const std::filesystem::path views = [] {
    std::filesystem::path made = folder / "views";
    std::filesystem::create_directory(made);
    unsigned seed = 1;
    for (const optics::Pose& pose : optics::Poses(95)) {
      WriteView(made / ("view" + std::to_string(seed) + ".tif"), pose, seed);
      ++seed;
    }
    return made;
  }();
  return views;
}

std::string Command(int columns) {
  return "geometry " + Views().string() + " --columns " + std::to_string(columns) +
         " --rows 5 --pitch 8 --bright --distortion-terms 1 ";
}

TEST(CliGeometry, ViewsOfDotsGiveFieldAnglesToAMap) {
  const TemporaryFolder folder;
  const std::string file = (folder / "geometry.json").string();
  const auto geometry = ParsedFrom<v1::GeometryResult>(
      RunEyebox(Command(kColumns) + "--pupil 2 --eye-pupil 1.5 --json --out " + file));
  EXPECT_GT(geometry.condition_number(), 1);
  EXPECT_TRUE(geometry.accepted());
  EXPECT_EQ(geometry.views_size(), 6);
  ASSERT_EQ(geometry.parameters_size(), 9);
  EXPECT_EQ(geometry.covariance_size(), 81);
  EXPECT_NEAR(geometry.parameters(0).value(), 219.8, 4 * geometry.parameters(0).sigma() + 0.5);
  ASSERT_EQ(geometry.warnings_size(), 1);
  EXPECT_THAT(geometry.warnings(0), HasSubstr("larger than the eye's"));
  EXPECT_NEAR(geometry.field_deg(1), 20, 0.3);

  const auto map = ParsedFrom<v1::UniformityResult>(
      RunEyebox("uniformity " + RecordedRig().string() + " --geometry " + file + " --out " +
                (folder / "maps").string() + " --json"));
  ASSERT_EQ(map.points_9_size(), 9);
  ASSERT_EQ(map.points_13_size(), 13);
  EXPECT_NEAR(map.points_9(4).g(), 1, 1e-9);
  EXPECT_NEAR(map.points_13(0).g(), 0.86, 0.02);  // of the rig, at 80 % to the upper left corner
  for (const v1::UniformityPoint& point : map.points_9()) {
    EXPECT_NEAR(point.x_deg(), std::atan((point.x_px() - 79.5) / 219.8) * 180 / std::numbers::pi,
                0.3);
  }
  bool over_field = false;
  for (const v1::MapFile& written : map.maps()) {
    if (written.name() != "g_field") continue;
    over_field = true;
    // 40 deg across in steps of 1 deg.
    EXPECT_NEAR(written.width_px(), 41, 1);
    EXPECT_TRUE(std::filesystem::exists(folder / "maps" / written.file()));
  }
  EXPECT_TRUE(over_field);
}

TEST(CliGeometry, ARecordingKeepsItsGeometry) {
  const TemporaryFolder folder;
  const std::filesystem::path recording = folder / "recording";
  std::filesystem::copy(RecordedRig(), recording, std::filesystem::copy_options::recursive);
  ASSERT_EQ(
      RunEyebox(Command(kColumns) + "--out " + (recording / "geometry.json").string()).exit_code,
      0);
  const auto run = ParsedFrom<v1::RunResult>(RunEyebox("run " + recording.string() + " --json"));
  EXPECT_THAT(run.files(), testing::Contains("uniformity_g_field.npy"));
}

TEST(CliGeometry, AFrameOfTheDisplayRegistersIt) {
  const TemporaryFolder folder;
  WriteView(folder / "display.tif", optics::At(0, 0, 95, 0, 0, 0), 9);
  const auto geometry = ParsedFrom<v1::GeometryResult>(RunEyebox(
      Command(kColumns) + "--display-frame " + (folder / "display.tif").string() +
      " --display-columns 7 --display-rows 5 --display-x 100 --display-y 80 --display-pitch 40 "
      "--display-order 1 --json"));
  const v1::DisplayRegistration& display = geometry.registration();
  EXPECT_EQ(display.points(), 35);
  EXPECT_EQ(display.centre_x_px(), 220);
  EXPECT_NEAR(display.horizontal_deg(0), 0, 0.3);
  EXPECT_GT(display.horizontal_deg(1), 0);  // columns run right
  EXPECT_LT(display.vertical_deg(2), 0);    // rows run down
}

TEST(CliGeometry, SaysWhatIsWrong) {
  const Outcome other = RunEyebox(Command(8));
  EXPECT_EQ(other.exit_code, 5);
  EXPECT_THAT(other.err, HasSubstr("view1.tif: shows 35 dots in a grid of 7 x 5, not 8 x 5"));
  const TemporaryFolder folder;
  const Outcome empty =
      RunEyebox("geometry " + folder.path().string() + " --columns 7 --rows 5 --pitch 8");
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_THAT(empty.err, HasSubstr("holds no PNG or TIFF image"));
  std::filesystem::copy(Views() / "view1.tif", folder / "view1.tif");
  std::filesystem::copy(Views() / "view2.tif", folder / "view2.tif");
  const Outcome few =
      RunEyebox("geometry " + folder.path().string() + " --columns 7 --rows 5 --pitch 8 --bright");
  EXPECT_EQ(few.exit_code, 3);
  EXPECT_THAT(few.err, HasSubstr("2 views of the target; take at least 3"));
  const Outcome strange =
      RunEyebox("uniformity " + RecordedRig().string() + " --geometry /dev/null");
  EXPECT_EQ(strange.exit_code, 3);
}

}  // namespace
}  // namespace eyebox::service
