#include "optics/sensor/emva1288/descriptor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "optics/sensor/emva1288/read_series.h"
#include "tests/support/grey_image.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::optics {
namespace {

using testing::HasSubstr;

constexpr char kGood[] =
    "# a comment\r\nv 3.0\r\nn 12 640 480\r\n\r\n"
    "b 1000000 1500,5\ni images\\a 1.png\ni images/b.tif\n"
    "d 1000000\ni d1.png\ni d2.png\n";

absl::StatusOr<Emva1288Descriptor> Parse(const std::string& text) {
  return ParseEmva1288Descriptor(text, "s.txt", "folder");
}

TEST(DescriptorTest, ReadsBothSlashesCommasAndWindowsLines) {
  const auto descriptor = Parse(kGood);
  ASSERT_TRUE(descriptor.ok()) << descriptor.status();
  EXPECT_EQ(descriptor->version, "3.0");
  EXPECT_EQ(descriptor->bits, 12);
  EXPECT_EQ(descriptor->size, (ImageSize{640, 480}));
  ASSERT_EQ(descriptor->sets.size(), 2U);
  const DescribedSet& bright = descriptor->sets[0];
  EXPECT_FALSE(bright.dark);
  EXPECT_EQ(bright.exposure_ns, 1e6);
  EXPECT_EQ(bright.photons, 1500.5);
  EXPECT_EQ(bright.images[0].file, "folder/images/a 1.png");
  EXPECT_EQ(bright.images[1].file, "folder/images/b.tif");
  EXPECT_EQ(bright.images[1].line, 7);
  EXPECT_TRUE(descriptor->sets[1].dark);
}

struct BadCase {
  const char* name;
  const char* text;
  const char* where;
  const char* what;
};

class BadDescriptors : public testing::TestWithParam<BadCase> {};

TEST_P(BadDescriptors, AreRejectedWithTheirLine) {
  const auto descriptor = Parse(GetParam().text);
  EXPECT_EQ(descriptor.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(descriptor.status().message(), HasSubstr(GetParam().where));
  EXPECT_THAT(descriptor.status().message(), HasSubstr(GetParam().what));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadDescriptors,
    testing::Values(
        BadCase{"Empty", "", "s.txt", "n bits width height"},
        BadCase{"NoSets", "n 8 4 4\n", "s.txt", "names no images"},
        BadCase{"UnknownCommand", "v 1\nx 3\n", "s.txt:2", "unknown command \"x\""},
        BadCase{"SecondFormat", "n 8 4 4\nn 8 4 4\n", "s.txt:2", "second n line"},
        BadCase{"SecondVersion", "v 1\nv 1\n", "s.txt:2", "second v line"},
        BadCase{"TooManyBits", "n 17 4 4\n", "s.txt:1", "out of range"},
        BadCase{"HugeSize", "n 8 4 99999999\n", "s.txt:1", "out of range"},
        BadCase{"WordForNumber", "n 8 4 4\nb one 2\n", "s.txt:2", "b exposure_ns photons"},
        BadCase{"NotANumber", "n 8 4 4\nb nan 2\n", "s.txt:2", "finite"},
        BadCase{"Infinite", "n 8 4 4\nd inf\n", "s.txt:2", "finite"},
        BadCase{"NegativeExposure", "n 8 4 4\nd -5\n", "s.txt:2", "not above 0"},
        BadCase{"NoPhotons", "n 8 4 4\nb 5 0\n", "s.txt:2", "d lines"},
        BadCase{"MissingField", "n 8 4 4\nb 5\n", "s.txt:2", "b exposure_ns photons"},
        BadCase{"ImageFirst", "n 8 4 4\ni a.png\n", "s.txt:2", "before the first b or d"},
        BadCase{"NoPath", "n 8 4 4\nd 5\ni\n", "s.txt:3", "i path"},
        BadCase{"OneImage", "n 8 4 4\nd 5\ni a.png\nd 6\n", "s.txt:2", "1 image"},
        BadCase{"OneImageAtTheEnd", "n 8 4 4\nd 5\ni a.png\n", "s.txt:2", "1 image"},
        BadCase{"Climbs", "n 8 4 4\nd 5\ni ..\\a.png\n", "s.txt:3", "leaves"},
        BadCase{"Absolute", "n 8 4 4\nd 5\ni /a.png\n", "s.txt:3", "leaves"},
        BadCase{"Drive", "n 8 4 4\nd 5\ni C:\\a.png\n", "s.txt:3", "leaves"},
        BadCase{"TwiceTheSame", "n 8 4 4\nd 5\ni a.png\ni b.png\nd 5\ni c.png\ni d.png\n",
                "s.txt:5", "same condition as line 2"}),
    [](const auto& test) { return test.param.name; });

class ReadSeriesTest : public testing::Test {
 protected:
  absl::StatusOr<SeriesCollector> Read(const std::string& text) {
    std::ofstream(folder_ / "s.txt") << text;
    const auto descriptor = ReadEmva1288Descriptor(folder_ / "s.txt");
    if (!descriptor.ok()) return descriptor.status();
    return ReadSeries(*descriptor, "s.txt");
  }
  TemporaryFolder folder_;
};

TEST_F(ReadSeriesTest, MissingImageIsNamedWithItsLine) {
  const auto series = Read("n 8 8 8\nd 5\ni a.png\ni b.png\n");
  EXPECT_EQ(series.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(series.status().message(), HasSubstr("s.txt:3"));
}

TEST_F(ReadSeriesTest, ImageOfAnotherSizeOrWithTooManyBitsIsNamedWithItsLine) {
  WriteGreyTiff(folder_ / "a.tif", Image<uint16_t>({8, 8}, 300), 16);
  WriteGreyTiff(folder_ / "b.tif", Image<uint16_t>({8, 9}, 3), 16);
  EXPECT_THAT(Read("n 12 8 8\nd 5\ni a.tif\ni b.tif\n").status().message(),
              testing::AllOf(HasSubstr("s.txt:4"), HasSubstr("8 x 9")));
  EXPECT_THAT(Read("n 8 8 8\nd 5\ni a.tif\ni a.tif\n").status().message(),
              testing::AllOf(HasSubstr("s.txt:2"), HasSubstr("above 255")));
}

TEST_F(ReadSeriesTest, MissingDescriptorIsNamed) {
  const auto descriptor = ReadEmva1288Descriptor(folder_ / "absent.txt");
  EXPECT_EQ(descriptor.status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(descriptor.status().message(), HasSubstr("absent.txt"));
}

}  // namespace
}  // namespace eyebox::optics
