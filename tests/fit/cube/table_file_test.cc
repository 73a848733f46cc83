#include "fit/cube/table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>

#include "capture/base/file.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::filesystem::path Scratch(const std::string& name) {
  static const TemporaryFolder folder;
  return folder / name;
}

TEST(TableFileTest, WhatIsWrittenIsReadBackBitForBit) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> uniform(-1, 60);
  Cube3d cube;
  cube.size = 7;
  cube.title = "round trip";
  cube.domain_min = {-1, 0, 0.25};
  cube.domain_max = {1, 58.875, 2};
  for (int i = 0; i < 343; ++i) {
    const float tiny = uniform(random) * 1e-30f;
    cube.entries.push_back({uniform(random), tiny, uniform(random) / 255});
  }
  const auto file = Scratch("round_trip.cube");
  ASSERT_TRUE(WriteFileAtomically(file, EncodeCube(cube)).ok());
  const auto read = ReadCube(file);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->size, cube.size);
  EXPECT_EQ(read->title, cube.title);
  EXPECT_EQ(read->domain_min, cube.domain_min);
  EXPECT_EQ(read->domain_max, cube.domain_max);
  EXPECT_EQ(read->entries, cube.entries);
}

TEST(TableFileTest, NumbersAreAsShortAsTheyCanBe) {
  Cube3d cube;
  cube.size = 2;
  cube.entries.assign(8, {0.1f, 1, 0});
  EXPECT_THAT(EncodeCube(cube), StartsWith("LUT_3D_SIZE 2\n0.1 1 0\n0.1 1 0\n"));
}

TEST(TableFileTest, TitleCannotBreakTheFile) {
  Cube3d cube;
  cube.size = 2;
  cube.title = "a \"b\"\nLUT_3D_SIZE 3";
  cube.entries.assign(8, {0, 0, 0});
  const auto file = Scratch("title.cube");
  ASSERT_TRUE(WriteFileAtomically(file, EncodeCube(cube)).ok());
  EXPECT_EQ(ReadCube(file)->title, "a  b  LUT_3D_SIZE 3");
}

TEST(TableFileTest, DesignedTableComesBackAsDesigned) {
  for (int size : {2, 32, 129}) {
    const auto table = *DesignTable({1, 100, 0.02, 2.2}, TableTarget::kHdrp, size);
    const auto file = Scratch("designed.cube");
    ASSERT_TRUE(WriteFileAtomically(file, *EncodeTable(table)).ok());
    const auto cube = ReadCube(file);
    ASSERT_TRUE(cube.ok()) << cube.status();
    ASSERT_EQ(cube->size, size);
    for (size_t i = 0; i < table.entries.size(); ++i) {
      const size_t n = table.entries.size();
      EXPECT_EQ(cube->entries[i][0], table.entries[i]);
      EXPECT_EQ(cube->entries[i * n][1], table.entries[i]);
      EXPECT_EQ(cube->entries[i * n * n][2], table.entries[i]);
    }
  }
}

TEST(TableFileTest, MissingFileIsNamed) {
  const auto cube = ReadCube(Scratch("no_such.cube"));
  EXPECT_EQ(cube.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(cube.status().message()), HasSubstr("no_such.cube"));
}

}  // namespace
}  // namespace eyebox::fit
