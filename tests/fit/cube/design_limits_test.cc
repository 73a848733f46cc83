#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "fit/cube/design_table.h"

namespace eyebox::fit {
namespace {

using ::testing::HasSubstr;

void ExpectRefused(const absl::Status& status, const std::string& word) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(word));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(DesignLimitsTest, OptionsOutOfRangeAreNamed) {
  EXPECT_TRUE(DesignOptions{}.Validate().ok());
  for (double white_u : {0.0, -1.0, kNan, kInfinity}) {
    ExpectRefused(DesignOptions{.white_u = white_u}.Validate(), "white_u");
  }
  for (double u_from : {0.0, 1.0, -0.1, kNan}) {
    ExpectRefused(DesignOptions{.u_from = u_from}.Validate(), "u_from");
  }
  for (int samples : {1, 0, -5, 2'000'000'000}) {
    ExpectRefused(DesignOptions{.samples = samples}.Validate(), "samples");
  }
}

TEST(DesignLimitsTest, SizeOutOfRangeIsRefused) {
  for (TableTarget target : {TableTarget::kHdrp, TableTarget::kResolve}) {
    for (int size : {-1, 0, 1, 130}) {
      ExpectRefused(DesignTable({}, target, size).status(), "table size");
    }
    EXPECT_TRUE(DesignTable({}, target, 129).ok());
  }
  ExpectRefused(DesignTable({}, TableTarget::kPps, 33).status(), "2 to 32 for target pps");
}

TEST(DesignLimitsTest, ActivationOutOfItsLimitsIsNamed) {
  const auto design = [](const Activation& activation) {
    return DesignTable(activation, TableTarget::kHdrp, 32).status();
  };
  for (double bad : {-1.0, kNan, kInfinity}) {
    ExpectRefused(design({.minimum_luminance = bad}), "minimum_luminance");
    ExpectRefused(design({.luminance_range = bad}), "luminance_range");
    ExpectRefused(design({.cutoff_drive = bad}), "cutoff_drive");
    ExpectRefused(design({.gamma = bad}), "gamma");
  }
  ExpectRefused(design({.luminance_range = 0}), "luminance_range");
  ExpectRefused(design({.cutoff_drive = 1}), "cutoff_drive");
  ExpectRefused(design({.gamma = 0}), "gamma");
}

TEST(DesignLimitsTest, WhiteBeyondTheAxisIsRefused) {
  ExpectRefused(DesignTable({}, TableTarget::kHdrp, 32, {.white_u = 59}).status(), "58.8566");
  ExpectRefused(DesignTable({}, TableTarget::kPps, 32, {.white_u = 1.01}).status(), "white_u");
}

TEST(DesignLimitsTest, TargetsHaveNames) {
  for (TableTarget target :
       {TableTarget::kHdrp, TableTarget::kPps, TableTarget::kResolve, TableTarget::kPtb}) {
    EXPECT_EQ(*TableTargetOf(NameOf(target)), target);
  }
  ExpectRefused(TableTargetOf("HDRP").status(), "hdrp, pps, resolve or ptb");
}

// The ends of what a display, a scene and a project can be.
TEST(DesignLimitsTest, ExtremesGiveFiniteRisingTables) {
  for (double gamma : {0.3, 1.0, 8.0}) {
    for (double minimum : {0.0, 1e3}) {
      for (double range : {1e-4, 1e5}) {
        for (double u_from : {1e-9, 0.999999}) {
          for (int size : {2, 31, 32}) {
            for (TableTarget target :
                 {TableTarget::kHdrp, TableTarget::kPps, TableTarget::kResolve}) {
              const auto table = DesignTable({minimum, range, 0.05, gamma}, target, size,
                                             {.u_from = u_from, .samples = 64});
              ASSERT_TRUE(table.ok()) << table.status();
              EXPECT_TRUE(std::isfinite(table->certificate.max_relative));
              EXPECT_GE(table->entries.front(), 0);
              EXPECT_LE(table->entries.back(), 65504);
              EXPECT_TRUE(std::ranges::is_sorted(table->entries));
            }
          }
        }
      }
    }
  }
}

TEST(DesignLimitsTest, LinearDisplayNeedsNoCurve) {
  const auto table = *DesignTable({0, 100, 0, 1}, TableTarget::kResolve, 17);
  for (size_t i = 0; i < 17; ++i) {
    EXPECT_NEAR(table.entries[i], static_cast<double>(i) / 16, 1e-7);
  }
  EXPECT_LT(table.certificate.max_relative, 1e-6);
}

TEST(DesignLimitsTest, StepOfEightBitsIsThatOfTheDarkestPair) {
  const auto table = *DesignTable({0, 100, 0, 2.0}, TableTarget::kHdrp, 32, {.u_from = 0.25});
  // h = v^2: 25 % of white is drive 127.5 of 255, so the steepest pair in range is 128 to 129.
  EXPECT_NEAR(table.certificate.contrast_step_8bit, std::pow(129.0 / 128, 2) - 1, 1e-12);
}

}  // namespace
}  // namespace eyebox::fit
