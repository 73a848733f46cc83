// Memory that is about to be written as a whole, and so need not be cleared first.
#ifndef EYEBOX_CAPTURE_BASE_UNINITIALISED_H_
#define EYEBOX_CAPTURE_BASE_UNINITIALISED_H_

#include <memory>
#include <utility>
#include <vector>

namespace eyebox {

// Leaves numbers that are given no value as the memory had them.
template <typename T>
struct UninitialisedAllocator : std::allocator<T> {
  template <typename U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  UninitialisedAllocator() = default;
  template <typename U>
  explicit UninitialisedAllocator(const UninitialisedAllocator<U>& /*other*/) {}

  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    std::construct_at(place, std::forward<Arguments>(arguments)...);
  }
};

// A vector whose resize() costs no pass over it; each element must be written before it is read.
template <typename T>
using UninitialisedVector = std::vector<T, UninitialisedAllocator<T>>;

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_UNINITIALISED_H_
