// All instruction sets give the same bits, and the right ones.
#include "fit/field/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "capture/base/random.h"

namespace eyebox::fit {
namespace {

constexpr int kLevels = 6;  // a multiple of kLevelTile
constexpr int kTileSize = kLevelTile * kLevelTile * kLanes;

struct Outcome {
  bool finite = false;
  std::vector<double> block = std::vector<double>(kLevels * kBlockLocations);
  std::vector<double> sums = std::vector<double>(kLevels * kLanes);
  std::vector<double> products = std::vector<double>(3 * kTileSize);
  std::vector<float> maps = std::vector<float>(4 * kBlockLocations);
  SquaredResiduals squared;
};

struct Input {
  std::vector<float> luminance;
  std::vector<uint8_t> valid;
  std::vector<double> numbers;  // [levels], for every array of the solver
};

Input SimulateInput() {
  Input input;
  RandomStream random({3});
  for (int i = 0; i < kLevels * kBlockLocations; ++i) {
    input.luminance.push_back(static_cast<float>(std::exp(20 * random.Uniform() - 10)));
  }
  for (int i = 0; i < kBlockLocations; ++i) input.valid.push_back(i % 5 == 0 ? 0 : 255);
  for (int i = 0; i < kLevels; ++i) input.numbers.push_back(random.Uniform() - 0.3);
  return input;
}

Outcome RunAll(const Kernels& kernels, const Input& input) {
  Outcome outcome;
  outcome.finite = kernels.load({input.luminance.data(), kBlockLocations, input.valid.data()},
                                kLevels, outcome.block.data());
  for (int repeat = 0; repeat < 3; ++repeat) {
    kernels.accumulate(outcome.block.data(), kLevels,
                       {outcome.sums.data(), outcome.products.data()});
  }
  const double* numbers = input.numbers.data();
  float* maps = outcome.maps.data();
  kernels.fit_lines(
      outcome.block.data(),
      {kLevels, numbers, numbers, numbers, numbers, numbers, 0.1, 0.2, 0.3, 0.4},
      {maps, maps + kBlockLocations, maps + 2 * kBlockLocations, maps + 3 * kBlockLocations},
      outcome.squared);
  return outcome;
}

template <typename T>
bool SameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void ExpectBitsOfGeneric(const Kernels* kernels) {
  if (kernels == nullptr) GTEST_SKIP() << "this processor or build has not these instructions";
  const Input input = SimulateInput();
  const Outcome expected = RunAll(*GenericKernels(), input);
  const Outcome outcome = RunAll(*kernels, input);
  EXPECT_TRUE(SameBits(outcome.block, expected.block));
  EXPECT_TRUE(SameBits(outcome.sums, expected.sums));
  EXPECT_TRUE(SameBits(outcome.products, expected.products));
  EXPECT_TRUE(SameBits(outcome.maps, expected.maps));
  EXPECT_EQ(outcome.squared.weighted, expected.squared.weighted);
  EXPECT_EQ(outcome.squared.relative, expected.squared.relative);
}

TEST(KernelsTest, Avx2GivesTheBitsOfAnyProcessor) { ExpectBitsOfGeneric(Avx2Kernels()); }
TEST(KernelsTest, Avx512GivesTheBitsOfAnyProcessor) { ExpectBitsOfGeneric(Avx512Kernels()); }

TEST(KernelsTest, ProductsAreThoseOfValidLocations) {
  const Input input = SimulateInput();
  const Outcome outcome = RunAll(BestKernels(), input);
  EXPECT_TRUE(outcome.finite);
  double expected = 0;  // of levels 1 and 5: the second tile, row 1, column 2
  for (int i = 0; i < kBlockLocations; ++i) {
    if (input.valid[i] == 0) continue;
    expected +=
        3.0 * input.luminance[kBlockLocations + i] * input.luminance[5 * kBlockLocations + i];
  }
  double product = 0;
  for (int lane = 0; lane < kLanes; ++lane) {
    product += outcome.products[kTileSize + (1 * kLevelTile + 2) * kLanes + lane];
  }
  EXPECT_NEAR(product / expected, 1, 1e-13);
}

TEST(KernelsTest, ValueThatIsNotFiniteIsSeenOnlyWhereValid) {
  for (const Kernels* kernels : {GenericKernels(), Avx2Kernels(), Avx512Kernels()}) {
    if (kernels == nullptr) continue;
    for (const float spoilt : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
      Input input = SimulateInput();
      input.luminance[2 * kBlockLocations + 10] = spoilt;  // masked
      EXPECT_TRUE(RunAll(*kernels, input).finite);
      input.luminance[2 * kBlockLocations + 11] = spoilt;
      EXPECT_FALSE(RunAll(*kernels, input).finite);
    }
  }
}

}  // namespace
}  // namespace eyebox::fit
