#include "capture/base/npy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "capture/base/file.h"
#include "tests/support/temporary_folder.h"

namespace eyebox {
namespace {

Image<float> Map() {
  Image<float> map({.width_px = 3, .height_px = 2});
  for (int i = 0; i < 6; ++i) map.pixels()[static_cast<size_t>(i)] = 0.1f * static_cast<float>(i);
  map.at(2, 1) = std::numeric_limits<float>::quiet_NaN();
  return map;
}

class Npy : public testing::Test {
 protected:
  absl::StatusOr<Image<float>> Read(const std::string& bytes) {
    EXPECT_TRUE(WriteFileAtomically(folder_ / "map.npy", bytes).ok());
    return ReadNpy(folder_ / "map.npy");
  }
  const TemporaryFolder folder_;
};

TEST_F(Npy, GivesBackWhatWasWritten) {
  const auto read = Read(EncodeNpy(Map()));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->size(), Map().size());
  EXPECT_EQ(read->at(1, 1), Map().at(1, 1));
  EXPECT_TRUE(std::isnan(read->at(2, 1)));
}

TEST_F(Npy, HeaderIsAlignedAsTheFormatAsks) {
  EXPECT_EQ((EncodeNpy(Map()).size() - 6 * sizeof(float)) % 64, 0U);
}

TEST_F(Npy, OfAnotherLengthIsDataLoss) {
  const std::string whole = EncodeNpy(Map());
  EXPECT_TRUE(absl::IsDataLoss(Read(whole.substr(0, whole.size() - 1)).status()));
  EXPECT_TRUE(absl::IsDataLoss(Read(whole + "x").status()));
}

TEST_F(Npy, OfAnotherKindIsRefused) {
  std::string other = EncodeNpy(Map());
  other.replace(other.find("<f4"), 3, "<f8");
  EXPECT_TRUE(absl::IsInvalidArgument(Read(other).status()));
  EXPECT_TRUE(absl::IsInvalidArgument(Read("").status()));
}

}  // namespace
}  // namespace eyebox
