#include "capture/camera/v4l2/v4l2_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "capture/camera/v4l2/v4l2_camera.h"
#include "tests/capture/v4l2/fake_video_device.h"

namespace eyebox::capture {
namespace {

TEST(V4l2Format, HasUniqueCodesAndNames) {
  std::set<uint32_t> codes;
  std::set<std::string_view> names;
  for (const V4l2Format& format : V4l2Formats()) {
    EXPECT_TRUE(codes.insert(format.fourcc).second) << format.name;
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_EQ(FindV4l2Format(format.fourcc), FindV4l2Format(format.name));
  }
}

TEST(V4l2Format, IsNamedByItsCodeWithoutTrailingSpaces) {
  for (const V4l2Format& format : V4l2Formats()) {
    std::string code;
    for (int shift = 0; shift < 32; shift += 8) code += static_cast<char>(format.fourcc >> shift);
    EXPECT_EQ(format.name, code.substr(0, code.find(' ')));
  }
  EXPECT_EQ(FourccName(V4L2_PIX_FMT_YUYV), "YUYV");
  EXPECT_EQ(FourccName(V4L2_PIX_FMT_Y4), "Y04");
  EXPECT_EQ(FindV4l2Format(uint32_t{V4L2_PIX_FMT_YUYV}), nullptr);
}

// Five pixels in two rows as the kernel's documentation lays them out.
struct Golden {
  const char* name;
  std::vector<uint8_t> upper;
  std::vector<uint8_t> lower;
  std::vector<uint16_t> counts_dn;
};

class V4l2GoldenFrame : public testing::TestWithParam<std::tuple<Golden, bool>> {};

TEST_P(V4l2GoldenFrame, ComesThroughRowsWithPadding) {
  const auto& [golden, multiplanar] = GetParam();
  FakeVideoDevice device;
  device.multiplanar = multiplanar;
  device.fourccs = {FindV4l2Format(std::string_view(golden.name))->fourcc};
  device.width = 5;
  device.height = 2;
  device.row_bytes = 32;
  device.draw = [&golden](uint32_t, std::span<uint8_t> bytes) {
    std::ranges::copy(golden.upper, bytes.begin());
    std::ranges::copy(golden.lower, bytes.subspan(32).begin());
  };
  auto camera = OpenV4l2Camera("v4l2:/dev/video0", &device.clock, &device);
  ASSERT_TRUE(camera.ok()) << camera.status();
  ASSERT_TRUE((*camera)->Configure({.exposure_s = 0.005}).ok());
  ASSERT_TRUE((*camera)->Start().ok());
  ASSERT_TRUE((*camera)->Trigger().ok());
  const auto frame = (*camera)->NextFrame(std::chrono::milliseconds(100));
  ASSERT_TRUE(frame.ok()) << frame.status();
  EXPECT_EQ(frame->metadata.status, BufferStatus::kComplete);
  EXPECT_EQ(frame->view.size, (ImageSize{.width_px = 5, .height_px = 2}));
  EXPECT_THAT(frame->view.pixels_dn, testing::ElementsAreArray(golden.counts_dn));
}

const Golden kGolden[] = {
    {"GREY", {0, 1, 127, 128, 255}, {9, 8, 7, 6, 5}, {0, 1, 127, 128, 255, 9, 8, 7, 6, 5}},
    {"RGGB",
     {10, 20, 30, 40, 50},
     {60, 70, 80, 90, 100},
     {10, 20, 30, 40, 50, 60, 70, 80, 90, 100}},
    {"Y10",
     {0x00, 0x00, 0x01, 0x00, 0xff, 0x03, 0x00, 0x02, 0x34, 0x01},
     {0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00},
     {0, 1, 1023, 512, 308, 1, 2, 3, 4, 5}},
    {"Y12",
     {0xff, 0x0f, 0x00, 0x08, 0x01, 0x00, 0x00, 0x00, 0xbc, 0x0a},
     {0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00},
     {4095, 2048, 1, 0, 0xabc, 1, 2, 3, 4, 5}},
    {"Y16",
     {0xff, 0xff, 0x00, 0x80, 0x01, 0x00, 0x34, 0x12, 0x00, 0x01},
     {0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00},
     {65535, 32768, 1, 0x1234, 256, 1, 2, 3, 4, 5}},
    {"BYR2",
     {0xff, 0xff, 0x00, 0x80, 0x01, 0x00, 0x34, 0x12, 0x00, 0x01},
     {0x01, 0x00, 0x02, 0x00, 0x03, 0x00, 0x04, 0x00, 0x05, 0x00},
     {65535, 32768, 1, 0x1234, 256, 1, 2, 3, 4, 5}},
    // High bytes 0x12 0x34 0x56 0x78, low bits 0 1 2 3 from the lowest; then one pixel of a group.
    {"Y10P",
     {0x12, 0x34, 0x56, 0x78, 0xe4, 0xff, 0, 0, 0, 0x03},
     {0x00, 0x00, 0x00, 0x00, 0x1b, 0x01, 0, 0, 0, 0x02},
     {0x048, 0x0d1, 0x15a, 0x1e3, 1023, 3, 2, 1, 0, 6}},
    // High bytes, then the low nibble of the first pixel below that of the second.
    {"Y12P",
     {0x12, 0x45, 0x63, 0xab, 0xff, 0xfc, 0x80, 0x00, 0x01},
     {0x00, 0x00, 0x21, 0x00, 0x00, 0x43, 0x00, 0x00, 0x05},
     {0x123, 0x456, 0xabc, 0xfff, 0x801, 1, 2, 3, 4, 5}},
    {"pRCC",
     {0x12, 0x45, 0x63, 0xab, 0xff, 0xfc, 0x80, 0x00, 0x01},
     {0x00, 0x00, 0x21, 0x00, 0x00, 0x43, 0x00, 0x00, 0x05},
     {0x123, 0x456, 0xabc, 0xfff, 0x801, 1, 2, 3, 4, 5}},
};

INSTANTIATE_TEST_SUITE_P(Formats, V4l2GoldenFrame,
                         testing::Combine(testing::ValuesIn(kGolden), testing::Bool()),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).name) +
                                  (std::get<1>(test.param) ? "MultiPlanar" : "SinglePlanar");
                         });

}  // namespace
}  // namespace eyebox::capture
