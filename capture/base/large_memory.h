// Memory for images: in large pages, and not cleared where it is about to be written as a whole.
#ifndef EYEBOX_CAPTURE_BASE_LARGE_MEMORY_H_
#define EYEBOX_CAPTURE_BASE_LARGE_MEMORY_H_

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace eyebox {

// Blocks of 4 MiB and more begin on a huge page and ask the kernel for more of them: a fresh image
// then costs one page fault in 2 MiB instead of 512, which otherwise takes longer than the work on
// it. Up to 512 MiB that were freed are kept for blocks of the same size. Thread-safe. Null if
// there is no memory.
void* AllocateLarge(size_t bytes);
// `bytes`: as many as were asked for.
void FreeLarge(void* block, size_t bytes);

// Elements that are given no value are left as the memory had them.
template <typename T>
struct LargeAllocator {
  using value_type = T;

  LargeAllocator() = default;
  template <typename U>
  LargeAllocator(const LargeAllocator<U>& /*other*/) {}  // NOLINT: allocators convert

  T* allocate(size_t count) { return static_cast<T*>(AllocateLarge(count * sizeof(T))); }
  void deallocate(T* block, size_t count) { FreeLarge(block, count * sizeof(T)); }

  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const LargeAllocator&, const LargeAllocator&) { return true; }
};

// A vector whose resize() costs no pass over it: each element must be written before it is read.
template <typename T>
using UninitialisedVector = std::vector<T, LargeAllocator<T>>;

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_LARGE_MEMORY_H_
