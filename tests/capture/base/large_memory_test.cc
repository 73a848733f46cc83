// Blocks for images: whole, apart from each other, and used again.
#include "capture/base/large_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

#include "capture/base/image.h"

namespace eyebox {
namespace {

TEST(LargeMemoryTest, BlocksOfEverySizeAreWholeAndApart) {
  std::vector<UninitialisedVector<uint8_t>> blocks;
  const size_t sizes[] = {0, 1, 4095, 65535, 65536, 65537, 4194303, 4194304, 4194305, 9000001};
  for (const size_t size : sizes) {
    for (uint8_t value = 1; value <= 2; ++value) {
      blocks.emplace_back();
      blocks.back().assign(size, value);
    }
  }
  for (size_t i = 0; i < blocks.size(); ++i) {
    const uint8_t value = i % 2 == 0 ? 1 : 2;
    EXPECT_EQ(std::count(blocks[i].begin(), blocks[i].end(), value), blocks[i].size()) << i;
  }
}

TEST(LargeMemoryTest, LargeBlocksBeginOnAHugePage) {
  const UninitialisedVector<uint8_t> block(size_t{8} << 20);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(block.data()) % (size_t{2} << 20), 0);
}

TEST(LargeMemoryTest, AnImageIsClearWhateverItsMemoryHeldBefore) {
  constexpr ImageSize kSize{2048, 1024};
  for (int round = 0; round < 3; ++round) {
    const Image<float> image(kSize);
    EXPECT_EQ(std::count(image.pixels().begin(), image.pixels().end(), 0.0F), kSize.PixelCount());
    Image<float> other = Image<float>::Unwritten(kSize);
    std::fill(other.pixels().begin(), other.pixels().end(), 7.0F);
  }
}

TEST(LargeMemoryTest, ThreadsGetBlocksOfTheirOwn) {
  std::vector<std::jthread> threads;
  std::vector<int> wrong(4);
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t, &wrong] {
      for (int round = 0; round < 50; ++round) {
        UninitialisedVector<int> block(100000);
        std::fill(block.begin(), block.end(), t);
        wrong[t] += std::count(block.begin(), block.end(), t) != 100000;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(wrong, std::vector<int>(4));
}

}  // namespace
}  // namespace eyebox
