#include "capture/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace eyebox {

void ForEachInParallel(int count, const std::function<void(int)>& work) {
  std::atomic<int> next = 0;
  const auto take = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  const int processors = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  std::vector<std::jthread> helpers;
  for (int k = 1; k < std::min(processors, count); ++k) helpers.emplace_back(take);
  take();
}

}  // namespace eyebox
