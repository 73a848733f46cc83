#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "capture/base/file.h"
#include "capture/base/image_file.h"
#include "fit/cube/table_file.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path Scratch(const std::string& name) {
  static const TemporaryFolder folder;
  return folder / name;
}

TableDesign ThreeEntries() {
  TableDesign table;
  table.target = TableTarget::kPps;
  table.size = 3;
  table.knots_u = {0, 0.5, 1};
  table.entries = {0, 100 / 255.0, 1};
  return table;
}

// 3 rows of 9: each block of 3 x 3 is one blue, red runs right, green runs up.
TEST(StripTest, PixelsLieWhereUnityLooksForThem) {
  const auto file = Scratch("strip.png");
  ASSERT_TRUE(WriteFileAtomically(file, *EncodeStrip(ThreeEntries())).ok());
  const auto image = *ReadPngRgb8(file);
  ASSERT_EQ(image.size(), (ImageSize{9, 3}));
  EXPECT_THAT(image.at(0, 2), ElementsAre(0, 0, 0)) << "black, lower left";
  EXPECT_THAT(image.at(8, 0), ElementsAre(255, 255, 255)) << "white, upper right";
  EXPECT_THAT(image.at(1, 2), ElementsAre(100, 0, 0)) << "red, to the right";
  EXPECT_THAT(image.at(0, 1), ElementsAre(0, 100, 0)) << "green, upwards";
  EXPECT_THAT(image.at(3, 2), ElementsAre(0, 0, 100)) << "blue, one block on";
  EXPECT_THAT(image.at(7, 0), ElementsAre(100, 255, 255));
}

TEST(StripTest, IsReadBackAsTheCubeItWas) {
  const auto file = Scratch("strip.png");
  ASSERT_TRUE(WriteFileAtomically(file, *EncodeTable(ThreeEntries())).ok());
  const auto cube = ReadStrip(file);
  ASSERT_TRUE(cube.ok()) << cube.status();
  EXPECT_EQ(cube->size, 3);
  EXPECT_EQ(cube->entries, ToCube(ThreeEntries(), "").entries);
}

TEST(StripTest, PictureOfAnotherShapeIsRefused) {
  const auto file = Scratch("other.png");
  for (ImageSize size : {ImageSize{9, 4}, ImageSize{33 * 33, 33}, ImageSize{1, 1}}) {
    ASSERT_TRUE(WritePng(file, Image<Rgb8>(size)).ok());
    const auto cube = ReadStrip(file);
    EXPECT_EQ(cube.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(cube.status().message()), HasSubstr("other.png"));
  }
}

TEST(StripTest, MissingFileIsNamed) {
  const auto cube = ReadStrip(Scratch("no_such.png"));
  EXPECT_EQ(cube.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(cube.status().message()), HasSubstr("no_such.png"));
}

TEST(StripTest, TableForAnotherTargetOrSizeIsNotEncoded) {
  TableDesign hdrp = ThreeEntries();
  hdrp.target = TableTarget::kHdrp;
  EXPECT_EQ(EncodeStrip(hdrp).status().code(), absl::StatusCode::kInvalidArgument);
  TableDesign large = ThreeEntries();
  large.size = 33;
  EXPECT_EQ(EncodeStrip(large).status().code(), absl::StatusCode::kInvalidArgument);
  TableDesign bright = ThreeEntries();
  bright.entries[2] = 1.5;
  EXPECT_EQ(EncodeStrip(bright).status().code(), absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace eyebox::fit
