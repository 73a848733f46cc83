// Independent pieces of work on all processors.
#ifndef EYEBOX_CAPTURE_BASE_PARALLEL_H_
#define EYEBOX_CAPTURE_BASE_PARALLEL_H_

#include <algorithm>
#include <cstddef>
#include <functional>

namespace eyebox {

// Calls work(0) to work(count - 1), each once, on as many threads as there are processors, the
// caller's among them; returns when all have returned. `work` must not throw, and pieces must not
// touch what others write. Which thread does what changes from run to run, so results must not
// depend on it.
void ForEachInParallel(int count, const std::function<void(int)>& work);

// One thread's share of an image: long enough that handing it out costs nothing.
constexpr size_t kParallelPiece = size_t{1} << 19;

inline int ParallelPieces(size_t count) {
  return static_cast<int>((count + kParallelPiece - 1) / kParallelPiece);
}

// Calls work(first, end) for consecutive pieces of [0, count), as above; pieces begin on multiples
// of kParallelPiece.
template <typename Work>
void ForEachPieceInParallel(size_t count, const Work& work) {
  ForEachInParallel(ParallelPieces(count), [&](int piece) {
    const size_t first = static_cast<size_t>(piece) * kParallelPiece;
    work(first, std::min(first + kParallelPiece, count));
  });
}

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_PARALLEL_H_
