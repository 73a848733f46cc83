#include "capture/base/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "capture/base/file.h"
#include "tests/support/grey_image.h"
#include "tests/support/temporary_folder.h"

namespace eyebox {
namespace {

using testing::HasSubstr;

constexpr ImageSize kSize = {.width_px = 6, .height_px = 5};

Image<uint16_t> Ramp(int step) {
  Image<uint16_t> image(kSize);
  for (size_t i = 0; i < image.pixels().size(); ++i) {
    image.pixels()[i] = static_cast<uint16_t>(static_cast<int>(i) * step);
  }
  return image;
}

// 2 x 2 px, written by an independent encoder (zlib level 9): grey 1, 2 | 3, 65535.
constexpr unsigned char kGrey16Png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0x07,
    0x4d, 0x8e, 0xbb, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60,
    0x60, 0x64, 0x60, 0x62, 0x60, 0x60, 0xfe, 0xff, 0x1f, 0x00, 0x03, 0x24, 0x02, 0x05, 0x89,
    0x93, 0xa4, 0xca, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

class ImageFile : public testing::Test {
 protected:
  absl::Status ReadBytes(const std::string& bytes) {
    std::ofstream(file_, std::ios::binary) << bytes;
    return ReadGreyImage(file_).status();
  }
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "image";
};

TEST_F(ImageFile, TiffKeepsCountsOfEightAndSixteenBits) {
  for (const int bits : {8, 16}) {
    const Image<uint16_t> image = Ramp(bits == 8 ? 8 : 2000);
    WriteGreyTiff(file_, image, bits);
    const auto read = ReadGreyImage(file_);
    ASSERT_TRUE(read.ok()) << read.status();
    EXPECT_EQ(read->bits_per_sample, bits);
    EXPECT_EQ(read->pixels_dn.size(), kSize);
    EXPECT_TRUE(std::ranges::equal(read->pixels_dn.pixels(), image.pixels()));
  }
}

TEST_F(ImageFile, TiffCutAnywhereIsNoImage) {
  for (const int bits : {8, 16}) {
    const std::string whole = EncodeGreyTiff(Ramp(8), bits);
    for (size_t length = 0; length < whole.size(); ++length) {
      const absl::Status status = ReadBytes(whole.substr(0, length));
      ASSERT_FALSE(status.ok()) << "cut at " << length;
      ASSERT_EQ(absl::IsDataLoss(status), length >= 4) << length << ": " << status;
      ASSERT_THAT(std::string(status.message()), HasSubstr(file_.string()));
    }
  }
}

TEST_F(ImageFile, PngKeepsCountsOfSixteenBits) {
  const std::string bytes(reinterpret_cast<const char*>(kGrey16Png), sizeof(kGrey16Png));
  std::ofstream(file_, std::ios::binary) << bytes;
  const auto read = ReadGreyImage(file_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->bits_per_sample, 16);
  EXPECT_THAT(
      std::vector<uint16_t>(read->pixels_dn.pixels().begin(), read->pixels_dn.pixels().end()),
      testing::ElementsAre(1, 2, 3, 65535));
}

TEST_F(ImageFile, PngCutOrDamagedAnywhereIsNoImage) {
  const std::string whole(reinterpret_cast<const char*>(kGrey16Png), sizeof(kGrey16Png));
  for (size_t at = 0; at < whole.size(); ++at) {
    ASSERT_FALSE(ReadBytes(whole.substr(0, at)).ok()) << "cut at " << at;
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 4);
    const absl::Status status = ReadBytes(flipped);
    ASSERT_FALSE(status.ok()) << "flipped at " << at;
    ASSERT_EQ(absl::IsDataLoss(status), at >= 8) << at << ": " << status;
  }
}

TEST_F(ImageFile, ColourIsRefused) {
  ASSERT_TRUE(WritePng(file_, Image<Rgb8>(kSize, Rgb8{1, 2, 3})).ok());
  const absl::Status status = ReadGreyImage(file_).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("greyscale"));
}

TEST_F(ImageFile, WhatIsNoImageIsRefused) {
  EXPECT_TRUE(absl::IsInvalidArgument(ReadBytes("GIF89a")));
  EXPECT_TRUE(absl::IsInvalidArgument(ReadBytes("")));
  EXPECT_TRUE(absl::IsNotFound(ReadGreyImage(folder_ / "none").status()));
}

TEST_F(ImageFile, RgbPngGivesBackWhatWasWritten) {
  Image<Rgb8> image(kSize);
  for (int y = 0; y < kSize.height_px; ++y) {
    for (int x = 0; x < kSize.width_px; ++x) {
      image.at(x, y) = {static_cast<uint8_t>(x), static_cast<uint8_t>(y), 255};
    }
  }
  ASSERT_TRUE(WritePng(file_, image).ok());
  const auto read = ReadPngRgb8(file_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_TRUE(std::ranges::equal(read->pixels(), image.pixels()));
  EXPECT_EQ(EncodePng(image).value(), ReadWholeFile(file_).value()) << "same bytes every time";
}

TEST_F(ImageFile, AnEmptyPngIsRefused) {
  EXPECT_FALSE(EncodePng(Image<Rgb8>()).ok());
  EXPECT_FALSE(WritePng(file_, Image<Rgb8>()).ok());
  EXPECT_FALSE(std::filesystem::exists(file_));
}

// Real frames are compressed with PackBits, which OpenCV alone fills up with black when cut.
TEST_F(ImageFile, ACompressedTiffCutInItsDataIsNoImage) {
  const auto real = std::filesystem::path(EYEBOX_SOURCE_DIR) /
                    "../shared/reference/frames/dark/d1_dark_25ms_2019-02-08-171117-0003.tif";
  if (!std::filesystem::exists(real)) GTEST_SKIP() << real << " is absent";
  const auto whole = ReadGreyImage(real);
  ASSERT_TRUE(whole.ok()) << whole.status();
  EXPECT_EQ(whole->bits_per_sample, 8);
  EXPECT_EQ(whole->pixels_dn.size(), (ImageSize{.width_px = 408, .height_px = 344}));
  // A hole in the data, everything else in place: only decoding can tell.
  std::string bytes = ReadWholeFile(real).value();
  bytes.erase(bytes.size() / 2, 100);
  bytes.insert(bytes.size() / 2, std::string(100, '\x80'));  // no-operation codes
  EXPECT_FALSE(ReadBytes(bytes).ok());
  EXPECT_FALSE(ReadBytes(ReadWholeFile(real).value().substr(0, bytes.size() / 2)).ok());
}

}  // namespace
}  // namespace eyebox
