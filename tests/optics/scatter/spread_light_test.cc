#include "optics/scatter/spread_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "capture/base/random.h"
#include "optics/scatter/kernel_grid.h"
#include "optics/scatter/torus.h"
#include "tests/optics/scatter/kernels.h"

namespace eyebox::optics {
namespace {

using ::testing::HasSubstr;

Image<float> RandomScene(ImageSize size, uint64_t seed) {
  RandomStream random({seed});
  Image<float> scene(size);
  for (float& value : scene.pixels()) value = static_cast<float>(100 * random.Uniform());
  return scene;
}

double Sum(const Image<float>& image) {
  return std::accumulate(image.pixels().begin(), image.pixels().end(), 0.0);
}

Image<float> Direct(const Image<float>& scene, const Image<float>& weights) {
  Image<float> out(scene.size());
  for (int y = 0; y < scene.size().height_px; ++y) {
    for (int x = 0; x < scene.size().width_px; ++x) {
      double sum = 0;
      for (int v = 0; v < scene.size().height_px; ++v) {
        for (int u = 0; u < scene.size().width_px; ++u) {
          sum += static_cast<double>(weights.at(std::abs(u - x), std::abs(v - y))) * scene.at(u, v);
        }
      }
      out.at(x, y) = static_cast<float>(sum);
    }
  }
  return out;
}

TEST(SpreadLightTest, FftIsTheDirectSum) {
  for (const ImageSize size : {ImageSize{1, 1}, {2, 1}, {3, 3}, {17, 30}, {45, 20}}) {
    const Image<float> scene = RandomScene(size, 1);
    for (const ScatterKernel& kernel : AllKernels()) {
      const auto spread = SpreadLight(scene, 0.1, kernel);
      ASSERT_TRUE(spread.ok()) << spread.status();
      const Image<float> direct = Direct(scene, SampleKernel(RadialWeight(kernel), 0.1, size));
      for (size_t i = 0; i < direct.pixels().size(); ++i) {
        ASSERT_NEAR(spread->pixels()[i], direct.pixels()[i], 1e-4) << size.width_px;
      }
    }
  }
}

TEST(SpreadLightTest, WorkMemoryHoldsNothingOver) {
  const ImageSize size{40, 24};
  Torus torus(size);
  const Image<float> transfer =
      torus.Transfer(SampleKernel(RadialWeight({.tail_share = 0.5}), 0.1, size));
  Image<float> first = RandomScene(size, 2);
  const Image<float> original = first;
  torus.Filter(first, transfer);
  Image<float> other = RandomScene(size, 3);
  torus.Filter(other, transfer);
  Image<float> again = original;
  torus.Filter(again, transfer);
  EXPECT_TRUE(std::ranges::equal(first.pixels(), again.pixels()));
}

TEST(SpreadLightTest, EnergyIsConserved) {
  Image<float> scene({200, 200});
  for (int y = 80; y < 120; ++y) {
    for (int x = 70; x < 130; ++x) scene.at(x, y) = 50;
  }
  for (ScatterKernel kernel : AllKernels()) {
    kernel.reach_deg = 6;  // 60 pixels: stays on the grid
    const auto spread = SpreadLight(scene, 0.1, kernel);
    ASSERT_TRUE(spread.ok());
    EXPECT_NEAR(Sum(*spread) / Sum(scene), 1, 2e-6);
  }
}

TEST(SpreadLightTest, BadInputIsNamed) {
  Image<float> scene({4, 3}, 1.0F);
  EXPECT_FALSE(SpreadLight(scene, 0, {}).ok());
  EXPECT_FALSE(SpreadLight(Image<float>{}, 0.1, {}).ok());
  EXPECT_FALSE(SpreadLight(scene, 0.1, {.tail_share = 2}).ok());
  scene.at(2, 1) = std::numeric_limits<float>::quiet_NaN();
  const auto spread = SpreadLight(scene, 0.1, {});
  EXPECT_EQ(spread.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(spread.status().message()), HasSubstr("pixel (2, 1)"));
}

}  // namespace
}  // namespace eyebox::optics
