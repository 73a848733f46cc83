#include "fit/color/colour_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fit/color/synthetic_display.h"

namespace eyebox::fit {
namespace {

ColourModel Display() {
  return SyntheticDisplay(ColourModelKind::kDriveCrosstalk, {0.08, 0.02, 0.045});
}

TEST(ColourTableTest, HdrpCubeMakesGreyAndPrimariesProportional) {
  const auto table = DesignColourTable(Display(), TableTarget::kHdrp, 32);
  ASSERT_TRUE(table.ok()) << table.status();
  for (const RampCertificate& ramp : table->ramps) {
    EXPECT_LT(ramp.luminance.max_relative, 0.012) << ramp.name;
    EXPECT_DOUBLE_EQ(ramp.u_reachable, 1) << ramp.name;
  }
  EXPECT_LT(table->ramps[0].max_chromaticity_error, 0.003);
  EXPECT_LT(table->interior.max_relative, 0.02);
  EXPECT_EQ(table->entries.outside_gamut, 0);
  EXPECT_EQ(table->entries.too_bright, 0);
  EXPECT_GT(table->entries.limited_by_black, 0);
  EXPECT_LT(table->goal.share_of_maximum, 1);
}

TEST(ColourTableTest, MoreEntriesLeaveLessError) {
  const auto coarse = DesignColourTable(Display(), TableTarget::kHdrp, 17);
  const auto fine = DesignColourTable(Display(), TableTarget::kHdrp, 48);
  ASSERT_TRUE(coarse.ok() && fine.ok());
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_LT(fine->ramps[i].luminance.max_relative, coarse->ramps[i].luminance.max_relative / 3);
  }
}

TEST(ColourTableTest, ChannelsByThemselvesWouldLeaveTheInteraction) {
  // What the cube undoes: the additive part of the same display, shown by the real one.
  ColourModel additive = Display();
  additive.kind = ColourModelKind::kAdditive;
  additive.interaction.clear();
  ColourTableOptions options;
  auto table = DesignColourTable(additive, TableTarget::kHdrp, 32, options);
  ASSERT_TRUE(table.ok());
  CertifyColourTable(Display(), options, *table);
  EXPECT_GT(table->ramps[0].luminance.max_relative, 0.05);
}

TEST(ColourTableTest, BrightestWhiteClipsPrimariesAndSaysSo) {
  ColourTableOptions options;
  options.goal.scale = WhiteScale::kWhite;
  const auto table = DesignColourTable(Display(), TableTarget::kHdrp, 32, options);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_LT(table->ramps[0].luminance.max_relative, 0.012);
  EXPECT_LT(table->ramps[1].u_reachable, 0.95);
  EXPECT_GT(table->ramps[1].luminance.max_relative, 0.05);
  EXPECT_GT(table->interior.colours_outside, 0);
  const auto uniform = DesignColourTable(Display(), TableTarget::kResolve, 17, options);
  ASSERT_TRUE(uniform.ok()) << uniform.status();
  EXPECT_GT(uniform->entries.too_bright, 0);
}

TEST(ColourTableTest, GamutBeyondTheDisplayIsCounted) {
  ColourTableOptions options;
  options.goal.gamut = ColourGamut::kP3;
  const auto table = DesignColourTable(Display(), TableTarget::kResolve, 17, options);
  ASSERT_TRUE(table.ok()) << table.status();
  EXPECT_GT(table->entries.outside_gamut, 0);
  EXPECT_GT(table->entries.max_chromaticity_error, 0.01);
  EXPECT_GT(table->interior.colours_outside, 0);
}

TEST(ColourTableTest, StripHoldsEightBitsAndReadsBack) {
  const auto table = DesignColourTable(Display(), TableTarget::kPps, 32);
  ASSERT_TRUE(table.ok()) << table.status();
  const auto bytes = EncodeColourTable(*table);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_EQ(bytes->substr(1, 3), "PNG");
  for (const auto& entry : table->cube.entries) {
    for (double component : entry) {
      EXPECT_DOUBLE_EQ(component * 255, std::round(component * 255));
    }
  }
}

TEST(ColourTableTest, CubeTextHoldsTheVeryEntries) {
  const auto table = DesignColourTable(Display(), TableTarget::kResolve, 5);
  ASSERT_TRUE(table.ok()) << table.status();
  const auto text = EncodeColourTable(*table);
  ASSERT_TRUE(text.ok());
  EXPECT_NE(text->find("LUT_3D_SIZE 5"), std::string::npos);
  for (const auto& entry : table->cube.entries) {
    for (double component : entry) EXPECT_EQ(component, static_cast<float>(component));
  }
}

TEST(ColourTableTest, ExtremeSizesAndRangesStayFinite) {
  for (int size : {2, 3, 65}) {
    for (double white_u : {0.01, 1.0, 50.0}) {
      ColourTableOptions options;
      options.white_u = white_u;
      options.samples = 64;
      const auto table = DesignColourTable(Display(), TableTarget::kHdrp, size, options);
      ASSERT_TRUE(table.ok()) << table.status();
      for (const auto& entry : table->cube.entries) {
        for (double component : entry) {
          EXPECT_TRUE(std::isfinite(component) && component >= 0);
        }
      }
    }
  }
}

TEST(ColourTableTest, BadRequestsAreRefused) {
  EXPECT_FALSE(DesignColourTable(Display(), TableTarget::kHdrp, 1).ok());
  EXPECT_FALSE(DesignColourTable(Display(), TableTarget::kHdrp, 130).ok());
  EXPECT_FALSE(DesignColourTable(Display(), TableTarget::kPps, 33).ok());
  ColourTableOptions options;
  options.u_from = 0;
  EXPECT_FALSE(DesignColourTable(Display(), TableTarget::kHdrp, 32, options).ok());
  options = {};
  options.white_u = 60;
  EXPECT_FALSE(DesignColourTable(Display(), TableTarget::kHdrp, 32, options).ok());
  ColourModel broken = Display();
  broken.gamma[0] = std::nan("");
  EXPECT_FALSE(DesignColourTable(broken, TableTarget::kHdrp, 32).ok());
}

}  // namespace
}  // namespace eyebox::fit
