#include "fit/cube/cube_parser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

namespace eyebox::fit {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const kEight =
    "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";  // identity, size 2

TEST(CubeParserTest, ReadsAllThatTheSpecificationAllows) {
  const auto cube = ParseCube(std::string("# made by hand\n\nTITLE \"Two by two\"\n") +
                                  "DOMAIN_MIN -0.5 0 0\nDOMAIN_MAX 1 2 1.5e1\nLUT_3D_SIZE 2\n\n" +
                                  kEight + "# the end\n",
                              "a.cube");
  ASSERT_TRUE(cube.ok()) << cube.status();
  EXPECT_EQ(cube->title, "Two by two");
  EXPECT_EQ(cube->size, 2);
  EXPECT_THAT(cube->domain_min, ElementsAre(-0.5, 0, 0));
  EXPECT_THAT(cube->domain_max, ElementsAre(1, 2, 15));
  ASSERT_EQ(cube->entries.size(), 8u);
  EXPECT_THAT(cube->entries[1], ElementsAre(1, 0, 0)) << "red fastest";
  EXPECT_THAT(cube->entries[4], ElementsAre(0, 0, 1));
}

TEST(CubeParserTest, LinesMayEndAsOnWindowsAndTheLastNotAtAll) {
  std::string text = std::string("LUT_3D_SIZE 2\n") + kEight;
  text.pop_back();
  std::string windows;
  for (char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(ParseCube(text, "a")->entries, ParseCube(windows, "b")->entries);
}

TEST(CubeParserTest, ResolveMayGiveOneRangeForAllChannels) {
  const auto cube =
      ParseCube(std::string("LUT_3D_SIZE 2\nLUT_3D_INPUT_RANGE -1.0 4.0\n") + kEight, "a");
  ASSERT_TRUE(cube.ok()) << cube.status();
  EXPECT_THAT(cube->domain_min, ElementsAre(-1, -1, -1));
  EXPECT_THAT(cube->domain_max, ElementsAre(4, 4, 4));
}

TEST(CubeParserTest, NumbersAreKeptAsFloat32) {
  const auto cube = ParseCube(
      "LUT_3D_SIZE 2\n0.1 1e-3 5.5\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n", "a");
  EXPECT_THAT(cube->entries[0], ElementsAre(0.1f, 1e-3f, 5.5));
}

struct Bad {
  std::string text;
  std::string where;
  std::string what;
};

TEST(CubeParserTest, EachFaultIsNamedWithItsLine) {
  const std::string size = "LUT_3D_SIZE 2\n";
  const std::string seven = std::string(kEight).substr(0, 7 * 6);
  const std::vector<Bad> bad = {
      {"", "f.cube:0", "without LUT_3D_SIZE"},
      {"# nothing\n", "f.cube:1", "without LUT_3D_SIZE"},
      {"0 0 0\n", "f.cube:1", "before LUT_3D_SIZE"},
      {size + seven, "f.cube:8", "after 7 of 8"},
      {size + kEight + "0 0 0\n", "f.cube:10", "surplus"},
      {size + "0 0 nan\n" + seven, "f.cube:2", "not a finite"},
      {size + "nan 0 0\n" + seven, "f.cube:2", "not a finite"},
      {size + "-inf 0 0\n" + seven, "f.cube:2", "not a finite"},
      {size + "1e99 0 0\n" + seven, "f.cube:2", "32-bit"},
      {size + "0 0\n" + seven, "f.cube:2", "three numbers"},
      {size + "0 0 0 0\n" + seven, "f.cube:2", "three numbers"},
      {size + "0 0,5 0\n" + seven, "f.cube:2", "\"0,5\""},
      {size + "0 0x1 0\n" + seven, "f.cube:2", "\"0x1\""},
      {size + seven + "TITLE \"late\"\n", "f.cube:9", "among the entries"},
      {size + size + kEight, "f.cube:2", "twice"},
      {"LUT_3D_SIZE 1\n", "f.cube:1", "2 to 129"},
      {"LUT_3D_SIZE 130\n", "f.cube:1", "2 to 129"},
      {"LUT_3D_SIZE 32.5\n", "f.cube:1", "2 to 129"},
      {"LUT_3D_SIZE\n", "f.cube:1", "2 to 129"},
      {"LUT_3D_SIZE 99999999999999999999\n", "f.cube:1", "2 to 129"},
      {"LUT_1D_SIZE 16\n", "f.cube:1", "one-dimensional"},
      {"TITLE Untitled\n" + size, "f.cube:1", "double quotes"},
      {"TITLE \"\n" + size, "f.cube:1", "double quotes"},
      {"\xEF\xBB\xBFTITLE \"x\"\n", "f.cube:1", "no keyword"},
      {"LUT_3D_INPUT_RANGE 0\n", "f.cube:1", "finite"},
      {"LUT_3D_INPUT_RANGE 0 1 2\n", "f.cube:1", "two numbers"},
      {"LUT_3D_INPUT_RANGE 1 0\n" + size + kEight, "f.cube:1", "domain is empty"},
      {"DOMAIN_MIN 0 0 0\nLUT_3D_INPUT_RANGE 0 1\n", "f.cube:2", "once"},
      {"LUT_3D_INPUT_RANGE 0 1\nDOMAIN_MIN 0 0 0\n", "f.cube:2", "once"},
      {"DOMAIN_MIN 0 0\n", "f.cube:1", "three numbers"},
      {size + "DOMAIN_MAX 1 0 1\n" + kEight, "f.cube:2", "domain is empty"},
      {"DOMAIN_MIN 2 2 2\n" + size + "DOMAIN_MAX 1 1 1\n" + kEight, "f.cube:3", "domain is empty"},
      {size + "DOMAIN_MIN 1 0 0\n" + kEight, "f.cube:2", "domain is empty"},
  };
  for (const Bad& b : bad) {
    const auto cube = ParseCube(b.text, "f.cube");
    ASSERT_FALSE(cube.ok()) << b.text;
    EXPECT_EQ(cube.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(cube.status().message()), StartsWith(b.where + ":")) << b.text;
    EXPECT_THAT(std::string(cube.status().message()), HasSubstr(b.what)) << b.text;
  }
}

TEST(CubeParserTest, SpoiltFilesGiveATableOrALineNeverACrash) {
  std::mt19937_64 random(11);
  const std::string good =
      std::string("TITLE \"t\"\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\nLUT_3D_SIZE 2\n") + kEight;
  int refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    std::string text = good;
    for (int k = 0; k <= trial % 4 && !text.empty(); ++k) {
      const size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random() % 256);
          break;
        case 1:
          text.erase(at, random() % 8);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 12));
          break;
        default:
          text.resize(at + 1);
      }
    }
    const auto cube = ParseCube(text, "f.cube");
    if (cube.ok()) {
      EXPECT_EQ(cube->entries.size(), static_cast<size_t>(cube->size) * cube->size * cube->size);
      continue;
    }
    ++refused;
    EXPECT_EQ(cube.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(cube.status().message()), testing::MatchesRegex("f.cube:[0-9]+: .*"));
  }
  EXPECT_GT(refused, 10000);
}

}  // namespace
}  // namespace eyebox::fit
