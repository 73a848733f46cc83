#include "optics/reduce/frame_stacker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "optics/reduce/measured_image.h"
#include "optics/reduce/saturation_mask.h"

namespace eyebox::optics {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr SensorRange kTwelveBits{12};

Image<uint16_t> Row(const std::vector<uint16_t>& dn) {
  Image<uint16_t> image({static_cast<int>(dn.size()), 1});
  std::copy(dn.begin(), dn.end(), image.pixels().begin());
  return image;
}

FrameView View(const Image<uint16_t>& image) { return {image.pixels(), image.size()}; }

TEST(FrameStackerTest, AveragesFramesAndCountsSaturation) {
  FrameStacker stacker({0.1, 0}, kTwelveBits);
  ASSERT_TRUE(stacker.Add(View(Row({1, 10, 4095}))).ok());
  ASSERT_TRUE(stacker.Add(View(Row({2, 10, 4000}))).ok());
  ASSERT_TRUE(stacker.Add(View(Row({2, 13, 4095}))).ok());
  const Stack stack = *stacker.Finish();
  EXPECT_EQ(stack.frames, 3);
  EXPECT_FLOAT_EQ(stack.mean_dn.at(0, 0), 5.0F / 3);
  EXPECT_FLOAT_EQ(stack.mean_dn.at(1, 0), 11.0F);
  EXPECT_THAT(stack.saturated_count.pixels(), ElementsAre(0, 0, 2));
}

TEST(FrameStackerTest, SaturationBeginsBelowFullScaleByTheMargin) {
  EXPECT_EQ(SensorRange{12}.SaturationDn(), 4079);  // floor(4095 * 255 / 256)
  EXPECT_EQ(SensorRange{8}.SaturationDn(), 254);
  EXPECT_EQ((SensorRange{12, 0}.SaturationDn()), 4095);
  FrameStacker stacker({0.1, 0}, kTwelveBits);
  ASSERT_TRUE(stacker.Add(View(Row({4078, 4079}))).ok());
  EXPECT_THAT(stacker.Finish()->saturated_count.pixels(), ElementsAre(0, 1));
}

TEST(FrameStackerTest, FrameOfAnotherSizeIsRejectedAndNotAdded) {
  FrameStacker stacker({0.1, 0}, kTwelveBits);
  ASSERT_TRUE(stacker.Add(View(Row({1, 2}))).ok());
  const absl::Status status = stacker.Add(View(Row({1, 2, 3})));
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("frame 2"));
  EXPECT_EQ(stacker.frames(), 1);
}

TEST(FrameStackerTest, CountAboveTheSignificantBitsIsRejected) {
  FrameStacker stacker({0.1, 0}, kTwelveBits);
  const absl::Status status = stacker.Add(View(Row({4096})));
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("4095"));
}

TEST(FrameStackerTest, BitsOutsideOneToSixteenAreRejected) {
  FrameStacker stacker({0.1, 0}, SensorRange{17});
  EXPECT_EQ(stacker.Add(View(Row({1}))).code(), absl::StatusCode::kInvalidArgument);
}

TEST(FrameStackerTest, StackOfNothingIsRejected) {
  EXPECT_EQ(FrameStacker({0.1, 0}, kTwelveBits).Finish().status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(FrameStackerTest, SumOfManyFullFramesDoesNotOverflow) {
  FrameStacker stacker({0.1, 0}, SensorRange{16});
  const Image<uint16_t> full = Row({65535});
  for (int k = 0; k < 65536; ++k) ASSERT_TRUE(stacker.Add(View(full)).ok());
  EXPECT_EQ(stacker.Add(View(full)).code(), absl::StatusCode::kInvalidArgument);
  const Stack stack = *stacker.Finish();
  EXPECT_EQ(stack.mean_dn.at(0, 0), 65535);
  EXPECT_EQ(stack.saturated_count.at(0, 0), 255);
}

TEST(SaturationMaskTest, SpreadsToNeighboursWithinTheImage) {
  Stack stack{{0.1, 0}, kTwelveBits, 1, Image<float>({4, 3}), Image<uint8_t>({4, 3})};
  stack.saturated_count.at(3, 0) = 1;
  EXPECT_THAT(SaturationMask(stack, 0, 1).pixels(),
              ElementsAre(0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(SaturationMask(stack, 1, 1).pixels(),
              ElementsAre(0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0));
  EXPECT_THAT(SaturationMask(stack, 9, 1).pixels(), ::testing::Each(kSaturated));
}

TEST(SaturationMaskTest, OnAMosaicTheOtherColoursKeepTheirCounts) {
  Stack stack{{0.1, 0}, kTwelveBits, 1, Image<float>({4, 3}), Image<uint8_t>({4, 3})};
  stack.saturated_count.at(3, 0) = 1;
  EXPECT_THAT(SaturationMask(stack, 1, 2).pixels(),
              ElementsAre(0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 1));
}

}  // namespace
}  // namespace eyebox::optics
