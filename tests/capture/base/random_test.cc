#include "capture/base/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace eyebox {
namespace {

// First outputs of SplitMix64 from state 0, as its authors publish them
// (https://prng.di.unimi.it/splitmix64.c): Next() there is MixBits of the state here.
TEST(MixBits, IsSplitMix64) {
  EXPECT_EQ(MixBits(0), 0xe220a8397b1dcdafU);
  EXPECT_EQ(MixBits(0x9e3779b97f4a7c15U), 0x6e789e6aa1b965f4U);
}

TEST(RandomStream, OfTheSameKeyIsTheSame) {
  RandomStream a{1, 2, 3};
  RandomStream b{1, 2, 3};
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.Next(), b.Next());
}

TEST(RandomStream, OfAnotherKeyIsAnother) {
  RandomStream a{1, 2};
  RandomStream swapped{2, 1};
  RandomStream longer{1, 2, 0};
  const uint64_t first = a.Next();
  EXPECT_NE(first, swapped.Next());
  EXPECT_NE(first, longer.Next());
}

TEST(RandomStream, UniformHasTheRightMomentsInAnOpenInterval) {
  RandomStream stream{7};
  constexpr int kCount = 100000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = stream.Uniform();
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 5 * 0.2887 / 316);
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 5 * 0.298 / 316);
}

TEST(RandomStream, BelowReachesEveryValueEquallyOften) {
  RandomStream stream{8};
  std::vector<int> counts(7);
  for (int i = 0; i < 70000; ++i) ++counts.at(stream.Below(7));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * 93);
}

}  // namespace
}  // namespace eyebox
