// The 8-bit table of the Post-Processing Stack: rounding as part of the design.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "capture/base/file.h"
#include "fit/cube/table_file.h"
#include "tests/fit/cube/evaluator.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::fit {
namespace {

using evaluator::Display;
using evaluator::Real;

Cube3d WrittenAndReadBack(const TableDesign& table) {
  const TemporaryFolder folder;
  const auto file = folder / "strip_design_test.png";
  EXPECT_TRUE(WriteFileAtomically(file, *EncodeTable(table)).ok());
  return *ReadStrip(file);
}

TEST(StripDesignTest, CertificateIsThatOfTheEightBitsInTheFile) {
  for (Real gamma : {1.8L, 2.2L, 2.6L}) {
    for (Real minimum : {0.0L, 2.0L}) {
      for (int size : {2, 16, 32}) {
        const Display display{minimum, 200, 0.02L, gamma};
        const auto table = *DesignTable(ActivationOf(display), TableTarget::kPps, size);
        for (size_t i = 0; i < table.entries.size(); ++i) {
          const double level = 255 * table.entries[i];
          EXPECT_NEAR(level, std::round(level), 1e-9);
          if (i > 0) {
            EXPECT_GE(table.entries[i], table.entries[i - 1]);
          }
        }
        const auto measured = evaluator::Measure(display, WrittenAndReadBack(table),
                                                 TableTarget::kPps, 1, 0.05L, 20011);
        EXPECT_LE(measured.worst, table.certificate.max_relative * 1.002);
        EXPECT_GE(measured.worst, table.certificate.max_relative * 0.99);
        EXPECT_NEAR(static_cast<double>(measured.rms), table.certificate.rms_relative,
                    0.01 * table.certificate.max_relative);
      }
    }
  }
}

Real WorstOf(const Display& display, const TableDesign& table) {
  return evaluator::Measure(display, ToCube(table, ""), TableTarget::kPps, 1, 0.05L, 501).worst;
}

TEST(StripDesignTest, BeatsRoundingEachEntryByItself) {
  for (Real gamma : {1.8L, 2.2L, 2.6L}) {
    const Display display{0, 200, 0, gamma};
    const Activation activation = ActivationOf(display);
    const auto joint = *DesignTable(activation, TableTarget::kPps, 32);
    TableDesign alone = joint;
    for (size_t i = 0; i < 32; ++i) {
      alone.entries[i] = std::round(255 * activation.InverseH(static_cast<double>(i) / 31)) / 255;
    }
    std::printf("gamma %.1Lf: rounded alone %.2Lf %%, jointly %.2Lf %%\n", gamma,
                100 * WorstOf(display, alone), 100 * WorstOf(display, joint));
    EXPECT_LT(WorstOf(display, joint), 0.95 * WorstOf(display, alone));
  }
}

// Three entries can be tried out: no other whole numbers do better.
TEST(StripDesignTest, SmallTableIsTheBestOfAll) {
  const Display display{0, 200, 0, 2.2L};
  const auto table = *DesignTable(ActivationOf(display), TableTarget::kPps, 3);
  constexpr int kPoints = 61;
  std::array<Real, kPoints> wanted, weight;
  std::array<bool, kPoints> upper;
  for (int i = 0; i < kPoints; ++i) {
    const Real x = std::pow(0.05L, 1 - static_cast<Real>(i) / (kPoints - 1));
    wanted[i] = display.Wanted(x);
    upper[i] = x > 0.5L;
    weight[i] = upper[i] ? 2 * x - 1 : 2 * x;
  }
  Real best = std::numeric_limits<Real>::infinity();
  for (int a = 0; a < 256; ++a) {
    for (int b = a; b < 256; ++b) {
      Real lower_worst = 0;
      for (int i = 0; i < kPoints && lower_worst < best; ++i) {
        if (upper[i]) continue;
        const Real drive = ((1 - weight[i]) * a + weight[i] * b) / 255;
        lower_worst = std::max(lower_worst, std::abs(display.Luminance(drive) / wanted[i] - 1));
      }
      for (int c = b; c < 256 && lower_worst < best; ++c) {
        Real worst = lower_worst;
        for (int i = kPoints; i-- > 0 && worst < best;) {
          if (!upper[i]) continue;
          const Real drive = ((1 - weight[i]) * b + weight[i] * c) / 255;
          worst = std::max(worst, std::abs(display.Luminance(drive) / wanted[i] - 1));
        }
        best = std::min(best, worst);
      }
    }
  }
  EXPECT_LE(table.certificate.max_relative, best * 1.01);
}

TEST(StripDesignTest, RenderedValueMayReachWhiteEarly) {
  const Display display{0, 200, 0, 2.2L};
  const auto table = *DesignTable(ActivationOf(display), TableTarget::kPps, 32, {.white_u = 0.5});
  EXPECT_EQ(table.entries.back(), 1);
  EXPECT_NEAR(DriveThroughTable(table, 0.5), 1, 0.01);
  EXPECT_LT(table.certificate.max_relative, 0.03);
}

}  // namespace
}  // namespace eyebox::fit
