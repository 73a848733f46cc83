// Wrong tables are made here by arithmetic of the test's own, with 8-bit output and noisy readings.
#include "fit/cube/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>

#include "fit/cube/block_compression.h"
#include "tests/fit/cube/evaluator.h"

namespace eyebox::fit {
namespace {

using evaluator::Real;

constexpr double kNoise = 0.005;
constexpr int kPatches = 16;

// Green alone; enough where the channels are alike.
Real DriveOf(const TableDesign& table, Real u, int read_size, bool srgb_import) {
  const Real axis = evaluator::HdrpAxis(u);
  const Real texture = (axis * (read_size - 1) + 0.5L) / read_size;
  const Real position = std::clamp<Real>(texture * table.size - 0.5L, 0, table.size - 1);
  const auto below = std::min<size_t>(static_cast<size_t>(position), table.entries.size() - 2);
  const auto entry = [&](size_t i) {
    const Real e = table.entries[i];
    if (!srgb_import) return e;
    const Real cut = std::min<Real>(e, 1);
    return cut <= 0.04045L ? cut / 12.92L : std::pow((cut + 0.055L) / 1.055L, 2.4L);
  };
  const Real share = position - static_cast<Real>(below);
  const Real mix = (1 - share) * entry(below) + share * entry(below + 1);
  return std::clamp<Real>(evaluator::EncodeSrgb(mix), 0, 1);
}

struct Shown {
  int read_size = 32;
  bool srgb_import = false;
  double exponent = 1;
  bool compressed = false;
};

class ProbeTest : public ::testing::Test {
 protected:
  Real LuminanceOf(Real u, const Shown& shown) const {
    const auto on_8_bits = [&](Real v) {
      const Real framebuffer = std::round(255 * v) / 255;
      return display_.Luminance(std::pow(framebuffer, static_cast<Real>(shown.exponent)));
    };
    if (!shown.compressed) {
      return on_8_bits(DriveOf(table_, u, shown.read_size, shown.srgb_import));
    }
    const auto drive = evaluator::Drive(compressed_, TableTarget::kHdrp, {u, u, u});
    return 0.2126L * on_8_bits(drive[0]) + 0.7152L * on_8_bits(drive[1]) +
           0.0722L * on_8_bits(drive[2]);
  }

  std::vector<ProbeReading> Read(const Shown& shown, double noise, unsigned seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<ProbeReading> readings;
    for (double u : patches_) {
      // The instrument is 7 % off, all along.
      const double truth = 1.07 * static_cast<double>(LuminanceOf(u, shown));
      const double value = truth * (1 + noise * normal(random));
      readings.push_back({u, value, noise * value});
    }
    return readings;
  }

  ProbeVerdict Judge(const std::vector<ProbeReading>& readings) const {
    return *JudgeProbe(hypotheses_, activation_, readings);
  }

  evaluator::Display display_{1, 200, 0.02L, 2.2L};
  Activation activation_ = ActivationOf(display_);
  TableDesign table_ = *DesignTable(activation_, TableTarget::kHdrp, 32);
  Cube3d cube_ = ToCube(table_, "");
  Cube3d compressed_ = CompressBlocks(cube_);
  std::vector<ProbeHypothesis> hypotheses_ = *ProbeHypotheses(TableTarget::kHdrp, cube_);
  std::vector<double> patches_ = ChooseProbePatches(hypotheses_, activation_, kPatches, kNoise);
};

TEST_F(ProbeTest, EachWrongTableIsNamedAndSoIsTheRightOne) {
  constexpr int kSeeds = 40;
  const std::map<std::string, Shown> cases = {{"right table", {}},
                                              {"grading size 16", {.read_size = 16}},
                                              {"grading size 64", {.read_size = 64}},
                                              {"sRGB import", {.srgb_import = true}},
                                              {"block compression", {.compressed = true}},
                                              {"colour-managed desktop", {.exponent = 1.09}}};
  for (const auto& [name, shown] : cases) {
    int named = 0;
    int wrong = 0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const ProbeVerdict verdict = Judge(Read(shown, kNoise, seed));
      if (verdict.verdict == name) {
        ++named;
      } else if (verdict.verdict != "undecided" && verdict.verdict != "none of these") {
        ++wrong;
      }
    }
    std::printf("%-24s named %d of %d, another named %d\n", name.c_str(), named, kSeeds, wrong);
    EXPECT_GE(named, kSeeds * 9 / 10) << name;
    EXPECT_EQ(wrong, 0) << name;
  }
}

TEST_F(ProbeTest, CannotBeToldApartIsSaid) {
  int named = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const ProbeVerdict verdict = Judge(Read({}, 0.1, seed));
    if (verdict.verdict == "undecided") {
      EXPECT_THAT(verdict.reason, testing::HasSubstr("told apart"));
    } else {
      ++named;
    }
  }
  EXPECT_LE(named, 1);
}

TEST_F(ProbeTest, SomethingElseIsNotGivenAName) {
  // A display that is brighter in the middle than anything here explains.
  std::vector<ProbeReading> readings = Read({}, kNoise, 1);
  for (ProbeReading& reading : readings) reading.luminance *= 1 + reading.u * (1 - reading.u);
  EXPECT_EQ(Judge(readings).verdict, "none of these");
}

TEST_F(ProbeTest, ExponentOfTheDesktopIsFound) {
  const ProbeVerdict verdict = Judge(Read({.exponent = 1.09}, kNoise, 3));
  EXPECT_NEAR(verdict.likelihoods.back().exponent, 1.09, 0.01);
  EXPECT_NEAR(verdict.likelihoods.back().scale, 1.07, 0.02);
}

TEST_F(ProbeTest, BadReadingsAreRefused) {
  std::vector<ProbeReading> readings = Read({}, kNoise, 1);
  readings[2].sigma = 0;
  EXPECT_FALSE(JudgeProbe(hypotheses_, activation_, readings).ok());
  EXPECT_FALSE(JudgeProbe(hypotheses_, activation_, std::span(readings).first(3)).ok());
  EXPECT_FALSE(ProbeHypotheses(TableTarget::kPtb, cube_).ok());
}

TEST(BlockCompressionTest, BlockOfFourColoursIsKeptToItsBits) {
  Cube3d cube;
  cube.size = 4;
  for (int i = 0; i < 64; ++i) {
    const double step = i % 4;
    cube.entries.push_back({step * 10 / 31 / 3 * 3 / 3, 0, 1});
  }
  const Cube3d held = CompressBlocks(cube);
  for (size_t i = 0; i < 64; ++i) EXPECT_NEAR(held.entries[i][0], cube.entries[i][0], 1e-12);
  cube.entries[5] = {2, 0.5, -1};
  for (const auto& entry : CompressBlocks(cube).entries) {
    for (double value : entry) EXPECT_TRUE(value >= 0 && value <= 1);
  }
}

}  // namespace
}  // namespace eyebox::fit
