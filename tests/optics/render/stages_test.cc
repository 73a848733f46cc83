#include "optics/render/stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "optics/render/log_c.h"
#include "optics/render/render_pipeline.h"
#include "optics/render/srgb.h"

namespace eyebox::optics {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

SharedTable Share(ColourTable table) {
  return std::make_shared<const ColourTable>(std::move(table));
}

TEST(StagesTest, PackedBufferHasSixSixAndFiveBits) {
  const Rgb stored = PackedFloatBuffer{}.Apply({0.999, 0.999, 0.999});
  EXPECT_EQ(stored, (Rgb{127.0 / 128, 127.0 / 128, 63.0 / 64}));
  const PackedFloatBuffer rounded{Rounding::kNearestEven};
  EXPECT_EQ(rounded.Apply({0.999, 0.999, 0.999}), (Rgb{1, 1, 1}));
}

TEST(StagesTest, ExposureHalvesPerStop) {
  EXPECT_EQ(Exposure{2}.Apply({1, 2, 4}), (Rgb{0.25, 0.5, 1}));
}

TEST(StagesTest, EightBitBuffersReachEveryLevelAndClamp) {
  for (int level = 0; level < 256; ++level) {
    const double v = level / 255.0;
    EXPECT_EQ(QuantiseTo8Bits{}.Apply({v, v + 0.00195, v - 0.00195})[0], v);
    EXPECT_NEAR(SrgbBuffer{}.Apply({SrgbToLinear(v), 0, 0})[0], SrgbToLinear(v), 1e-15);
  }
  EXPECT_EQ(QuantiseTo8Bits{}.Apply({-1, 7, kNan}), (Rgb{0, 1, 0}));
  EXPECT_EQ(Saturate{}.Apply({-1, 7, kNan}), (Rgb{0, 1, 0}));
  EXPECT_EQ(Saturate{}.Apply({0.3, 1, 0}), (Rgb{0.3, 1, 0}));
}

// The three channels of a cube that mixes them, against the formula written out.
TEST(ColourTableTest, TrilinearReproducesATrilinearFunction) {
  ColourTable table{3, {}};
  for (int b = 0; b < 3; ++b) {
    for (int g = 0; g < 3; ++g) {
      for (int r = 0; r < 3; ++r)
        table.entries.push_back({1.0 * r * g * b, r + 2.0 * g, 3.0 * b - r});
    }
  }
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 2);
  for (int i = 0; i < 1000; ++i) {
    const double r = uniform(random);
    const double g = uniform(random);
    const double b = uniform(random);
    const Rgb read = SampleTrilinear(table, {r, g, b});
    EXPECT_NEAR(read[0], r * g * b, 1e-14);
    EXPECT_NEAR(read[1], r + 2 * g, 1e-14);
    EXPECT_NEAR(read[2], 3 * b - r, 1e-14);
  }
}

TEST(ColourTableTest, ClampsOutsideAndPassesNan) {
  const ColourTable table = SeparableTable({0.25, 0.5, 1});
  EXPECT_EQ(SampleTrilinear(table, {-1, 1, 9}), (Rgb{0.25, 0.5, 1}));
  EXPECT_TRUE(std::isnan(SampleTrilinear(table, {0, kNan, 0})[0]));
}

TEST(ColourTableTest, AnInfiniteEntryWithoutWeightIsNotRead) {
  const ColourTable table = SeparableTable({0, 1, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(SampleTrilinear(table, {0.5, 1, 1}), (Rgb{0.5, 1, 1}));
}

TEST(ColourTableTest, EightBitWeightsAreSteps) {
  const ColourTable table = SeparableTable({0, 1});
  EXPECT_EQ(SampleTrilinear(table, {0.3, 0.001, 0.999}, 8), (Rgb{77.0 / 256, 0, 1}));
}

TEST(StagesTest, LogCTableReturnsItsEntriesAtTheKnotsAndIsLinearInLogC) {
  std::vector<double> values(32);
  for (int i = 0; i < 32; ++i) values[i] = i * i;
  const LogCTable stage{Share(SeparableTable(values))};
  for (int i = 2; i < 31; ++i) {
    const double u = LogCToLinear(i / 31.0);
    EXPECT_NEAR(stage.Apply({u, u, u})[1], values[i], 1e-9 * values[i]);
    const double between = LogCToLinear((i + 0.25) / 31);
    EXPECT_NEAR(stage.Apply({between, 1, 1})[0], 0.75 * values[i] + 0.25 * values[i + 1], 1e-9);
  }
  EXPECT_NEAR(stage.Apply({1e6, 0, 0})[0], 961, 1e-12);
}

TEST(StagesTest, KnotTableIsLinearInUAndConstantOutside) {
  const KnotTable stage{Share(SeparableTable({1, 3, 11})), {0.1, 0.5, 2}};
  EXPECT_EQ(stage.Apply({0, 0.1, 5}), (Rgb{1, 1, 11}));
  const Rgb inside = stage.Apply({0.2, 0.5, 1.25});
  EXPECT_NEAR(inside[0], 1.5, 1e-14);
  EXPECT_NEAR(inside[1], 3, 1e-14);
  EXPECT_NEAR(inside[2], 7, 1e-14);
  EXPECT_TRUE(std::isnan(stage.Apply({kNan, 1, 1})[0]));
}

TEST(StagesTest, UniformTableSpansZeroToOne) {
  const UniformTable stage{Share(SeparableTable({0, 0.2, 1}))};
  const Rgb read = stage.Apply({0.25, 0.5, 2});
  EXPECT_NEAR(read[0], 0.1, 1e-15);
  EXPECT_NEAR(read[1], 0.2, 1e-15);
  EXPECT_EQ(read[2], 1);
}

TEST(RenderPipelineTest, RunsItsStagesInOrder) {
  const RenderPipeline pipeline = {DecodeSrgb{}, Exposure{1}, PackedFloatBuffer{}, EncodeSrgb{},
                                   QuantiseTo8Bits{}};
  const double u = std::floor(SrgbToLinear(0.8) / 2 * 256) / 256;  // 6 bits of [0.25, 0.5)
  const Rgb v = RunPipeline(pipeline, {0.8, 0.8, 0});
  EXPECT_EQ(v[0], std::round(LinearToSrgb(u) * 255) / 255);
  EXPECT_EQ(v[2], 0);
  EXPECT_EQ(RunPipeline({}, {1, 2, 3}), (Rgb{1, 2, 3}));
  EXPECT_EQ(NameOf(pipeline[2]), "R11G11B10, truncated");
}

}  // namespace
}  // namespace eyebox::optics
