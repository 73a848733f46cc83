#include "capture/base/unpack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "capture/base/random.h"

namespace eyebox {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

std::vector<std::byte> Bytes(const std::vector<int>& values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// Worked by hand from the bit diagrams of PFNC 2.4, GigE Vision 2.0 and MIPI CSI-2.
struct Golden {
  const char* name;
  PixelPacking packing;
  std::vector<int> bytes;
  std::vector<uint16_t> counts_dn;
};

class GoldenVector : public testing::TestWithParam<Golden> {};

TEST_P(GoldenVector, UnpacksWholeAndInEveryPart) {
  const Golden& golden = GetParam();
  for (size_t width = 0; width <= golden.counts_dn.size(); ++width) {
    // A copy of exactly the bytes that are needed, so that a sanitizer sees a read behind them.
    const size_t need = PackedBytes(golden.packing, width);
    ASSERT_LE(need, golden.bytes.size());
    auto exact = std::make_unique<std::byte[]>(need);
    const std::vector<std::byte> bytes = Bytes(golden.bytes);
    std::memcpy(exact.get(), bytes.data(), need);
    std::vector<uint16_t> counts_dn(width, 0xBEEF);
    const ImageSize size = {.width_px = static_cast<int>(width), .height_px = 1};
    const auto status = Unpack(golden.packing, {exact.get(), need}, size, 0, counts_dn);
    ASSERT_TRUE(status.ok()) << status;
    EXPECT_THAT(counts_dn, ElementsAreArray(golden.counts_dn.data(), width));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Packings, GoldenVector,
    testing::Values(
        Golden{"Bytes", PixelPacking::kBytes, {0x00, 0x7F, 0xFF}, {0, 127, 255}},
        Golden{"Words",
               PixelPacking::kWords,
               {0x34, 0x12, 0xFF, 0x0F, 0xFF, 0xFF},
               {0x1234, 0x0FFF, 0xFFFF}},
        // 0x001, 0x3FF, 0x2AA, 0x155 from the lowest bit up: 01 FC AF 6A 55; then 0x123 begins.
        Golden{"Mono10p",
               PixelPacking::k10Lsb,
               {0x01, 0xFC, 0xAF, 0x6A, 0x55, 0x23, 0x01},
               {0x001, 0x3FF, 0x2AA, 0x155, 0x123}},
        // 0xABC, 0x123: BC 3A 12; 0x001, 0xFFE: 01 E0 FF; then 0x765 alone.
        Golden{"Mono12p",
               PixelPacking::k12Lsb,
               {0xBC, 0x3A, 0x12, 0x01, 0xE0, 0xFF, 0x65, 0x07},
               {0xABC, 0x123, 0x001, 0xFFE, 0x765}},
        // 0x2A9 = AA|01, 0x156 = 55|10: AA 21 55; 0x003 = 00|11, 0x3FC = FF|00: 00 03 FF; 0x201.
        Golden{"Mono10Packed",
               PixelPacking::k10GigE,
               {0xAA, 0x21, 0x55, 0x00, 0x03, 0xFF, 0x80, 0x01},
               {0x2A9, 0x156, 0x003, 0x3FC, 0x201}},
        // 0xABC, 0x123: AB 3C 12; 0x001, 0xFFE: 00 E1 FF; then 0x765 alone.
        Golden{"Mono12Packed",
               PixelPacking::k12GigE,
               {0xAB, 0x3C, 0x12, 0x00, 0xE1, 0xFF, 0x76, 0x05},
               {0xABC, 0x123, 0x001, 0xFFE, 0x765}},
        // High bytes 00 FF AA 55, low pairs 01 11 10 01 from the lowest up: 01|11<<2|10<<4|01<<6.
        Golden{"Mipi10",
               PixelPacking::k10Mipi,
               {0x00, 0xFF, 0xAA, 0x55, 0x6D},
               {0x001, 0x3FF, 0x2AA, 0x155}},
        Golden{"Mipi12",
               PixelPacking::k12Mipi,
               {0xAB, 0x12, 0x3C, 0x00, 0xFF, 0xE1},
               {0xABC, 0x123, 0x001, 0xFFE}}),
    [](const auto& each) { return std::string(each.param.name); });

// The same counts packed bit by bit, without the shifts that are tested.
std::vector<std::byte> PackByBits(const std::vector<uint16_t>& counts_dn, int bits) {
  std::vector<std::byte> packed((counts_dn.size() * bits + 7) / 8);
  for (size_t bit = 0; bit < counts_dn.size() * bits; ++bit) {
    if (counts_dn[bit / bits] >> bit % bits & 1) packed[bit / 8] |= std::byte(1 << bit % 8);
  }
  return packed;
}

TEST(Unpack, OddSizesRunOnWithinAByteFromRowToRow) {
  for (const auto& [packing, bits] :
       {std::pair{PixelPacking::k10Lsb, 10}, {PixelPacking::k12Lsb, 12}}) {
    for (const ImageSize size : {ImageSize{7, 5}, ImageSize{1, 9}, ImageSize{33, 3}}) {
      RandomStream random({7, static_cast<uint64_t>(bits), size.PixelCount()});
      std::vector<uint16_t> counts_dn(size.PixelCount());
      for (uint16_t& count : counts_dn) {
        count = static_cast<uint16_t>(random.Uniform() * (1 << bits));
      }
      std::vector<uint16_t> unpacked(size.PixelCount());
      ASSERT_TRUE(Unpack(packing, PackByBits(counts_dn, bits), size, 0, unpacked).ok());
      EXPECT_EQ(unpacked, counts_dn);
    }
  }
}

TEST(Unpack, SkipsWhatLiesBetweenRows) {
  const auto packed =
      Bytes({0xBC, 0x3A, 0x12, 0x01, 0x00, 0xEE, 0xEE, 0x65, 0x07, 0x0F, 0xFE, 0x0F});
  std::vector<uint16_t> counts_dn(6);
  ASSERT_TRUE(Unpack(PixelPacking::k12Lsb, packed, {3, 2}, 7, counts_dn).ok());
  EXPECT_THAT(counts_dn, testing::ElementsAre(0xABC, 0x123, 0x001, 0x765, 0x0F0, 0xFFE));
}

TEST(Unpack, ShortBuffersAreRefused) {
  std::vector<uint16_t> counts_dn(6);
  for (const auto packing : {PixelPacking::kBytes, PixelPacking::kWords, PixelPacking::k10Lsb,
                             PixelPacking::k12Lsb, PixelPacking::k10GigE, PixelPacking::k12GigE,
                             PixelPacking::k10Mipi, PixelPacking::k12Mipi}) {
    const std::vector<std::byte> packed(PackedBytes(packing, 6) - 1);
    const auto status = Unpack(packing, packed, {6, 1}, 0, counts_dn);
    EXPECT_TRUE(absl::IsInvalidArgument(status));
    EXPECT_THAT(std::string(status.message()), HasSubstr("the buffer holds"));
  }
}

TEST(Unpack, AStrideBelowARowAndCountsOfAnotherSizeAreRefused) {
  const std::vector<std::byte> packed(100);
  std::vector<uint16_t> counts_dn(6);
  EXPECT_TRUE(absl::IsInvalidArgument(Unpack(PixelPacking::kWords, packed, {3, 2}, 5, counts_dn)));
  EXPECT_TRUE(absl::IsInvalidArgument(Unpack(PixelPacking::kWords, packed, {3, 3}, 0, counts_dn)));
  EXPECT_TRUE(
      absl::IsInvalidArgument(Unpack(PixelPacking::kWords, packed, {-3, -2}, 0, counts_dn)));
}

TEST(Alignment, ShowsInTheBitsThatToggle) {
  const std::vector<uint16_t> low = {0x0123, 0x0FFF, 0x0001};
  const std::vector<uint16_t> high = {0x1230, 0xFFF0, 0x0010};
  const std::vector<uint16_t> deeper = {0x1231, 0xFFF0};
  const std::vector<uint16_t> dark = {0, 0, 0};
  EXPECT_EQ(DetectAlignment(low, 12), CountAlignment::kLow);
  EXPECT_EQ(DetectAlignment(high, 12), CountAlignment::kHigh);
  EXPECT_EQ(DetectAlignment(deeper, 12), CountAlignment::kUnknown);
  EXPECT_EQ(DetectAlignment(deeper, 16), CountAlignment::kLow);
  EXPECT_EQ(DetectAlignment(dark, 12), CountAlignment::kUnknown);
  EXPECT_EQ(DetectAlignment({}, 12), CountAlignment::kUnknown);
}

TEST(PixelFormats, AreFoundByCodeAndByName) {
  for (const PixelFormat& format : KnownPixelFormats()) {
    EXPECT_EQ(*FindPixelFormat(format.pfnc), format);
    EXPECT_EQ(*FindPixelFormat(format.name), format);
    // The code itself states the bits that a pixel takes.
    EXPECT_EQ((format.pfnc >> 16 & 0xFF) * 4, PackedBytes(format.packing, 4) * 8) << format.name;
  }
}

TEST(PixelFormats, MonoTwelvePackedIsNotMonoTwelveP) {
  EXPECT_EQ(FindPixelFormat(0x010C0006)->packing, PixelPacking::k12GigE);
  EXPECT_EQ(FindPixelFormat(0x010C0047)->packing, PixelPacking::k12Lsb);
  EXPECT_EQ(FindPixelFormat("BayerRG12")->mosaic, BayerMosaic::kRggb);
}

TEST(PixelFormats, ColourThatWasInterpolatedIsRefused) {
  const auto rgb8 = FindPixelFormat(0x02180014);
  EXPECT_TRUE(absl::IsInvalidArgument(rgb8.status()));
  EXPECT_THAT(std::string(rgb8.status().message()), HasSubstr("0x02180014"));
  EXPECT_THAT(std::string(rgb8.status().message()), HasSubstr("Mono12p"));
  EXPECT_FALSE(FindPixelFormat("mono16").ok());
}

}  // namespace
}  // namespace eyebox
