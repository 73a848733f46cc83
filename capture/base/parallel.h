// Independent pieces of work on all processors.
#ifndef EYEBOX_CAPTURE_BASE_PARALLEL_H_
#define EYEBOX_CAPTURE_BASE_PARALLEL_H_

#include <functional>

namespace eyebox {

// Calls work(0) to work(count - 1), each once, on as many threads as there are processors, the
// caller's among them; returns when all have returned. `work` must not throw, and pieces must not
// touch what others write. Which thread does what changes from run to run, so results must not
// depend on it.
void ForEachInParallel(int count, const std::function<void(int)>& work);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_PARALLEL_H_
