#include "fit/cube/gamma_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST(GammaTableTest, EveryLevelShowsItsShareOfWhite) {
  const evaluator::Display display{1, 200, 0.02L, 2.2L};
  const auto table = *DesignTable(ActivationOf(display), TableTarget::kPtb, 256);
  const auto read = ParseGammaTable(*EncodeGammaTable(table), "t");
  ASSERT_TRUE(read.ok()) << read.status();
  for (int level = 0; level < 256; ++level) {
    const evaluator::Real wanted = display.Wanted(level / 255.0L);
    EXPECT_LT(std::abs(display.Luminance((*read)[level][1]) / wanted - 1), 1e-6L) << level;
  }
  EXPECT_LT(table.certificate.max_relative, 1e-6);
  EXPECT_GT(table.certificate.samples, 200);
  EXPECT_NEAR(table.certificate.contrast_step_8bit, 1 / 13.0, 1e-4) << "13 to 14 of 255";
  // A converter of 8 bits behind the table leaves half a step.
  const auto coarse =
      *CertifyStored(table, ActivationOf(display), {}, StorageModel{.output8 = true});
  EXPECT_GT(coarse.certificate.max_relative, 0.005);
}

TEST(GammaTableTest, OtherSizesAreRefused) {
  EXPECT_FALSE(DesignTable({}, TableTarget::kPtb, 32).ok());
  auto table = *DesignTable({}, TableTarget::kPtb, 256);
  table.entries.pop_back();
  EXPECT_FALSE(EncodeGammaTable(table).ok());
}

TEST(GammaTableTest, EachFaultIsNamedWithItsLine) {
  std::string rows;
  for (int i = 0; i < 255; ++i) rows += "0.5 0.5 0.5\n";
  struct Bad {
    std::string text;
    std::string where;
    std::string what;
  };
  for (const Bad& bad : {Bad{rows, "f:255:", "ends after 255"},
                         {rows + "0.5 0.5 0.5\n0 0 0\n", "f:257:", "surplus"},
                         {rows + "0.5 0.5\n", "f:256:", "three"},
                         {rows + "0.5 0.5 0.5 0.5\n", "f:256:", "more than three"},
                         {"0 0 1.01\n" + rows, "f:1:", "outside"},
                         {"0 0 nan\n" + rows, "f:1:", "outside"},
                         {"0,0,0\n" + rows, "f:1:", "three"},
                         {"\n" + rows, "f:1:", "three"},
                         {"", "f:0:", "ends after 0"}}) {
    const auto table = ParseGammaTable(bad.text, "f");
    ASSERT_FALSE(table.ok()) << bad.what;
    EXPECT_THAT(std::string(table.status().message()), StartsWith(bad.where));
    EXPECT_THAT(std::string(table.status().message()), HasSubstr(bad.what));
  }
  EXPECT_TRUE(ParseGammaTable(rows + "1 1 1\r\n\n", "f").ok());
}

}  // namespace
}  // namespace eyebox::fit
