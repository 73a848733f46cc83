// Threads for what must not hold up a gRPC reactor.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_EXECUTOR_H_
#define EYEBOX_SERVICE_SERVER_JOBS_EXECUTOR_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace eyebox::service {

// Runs tasks in the order in which they were posted, `threads` at a time. Thread-safe.
class Executor {
 public:
  explicit Executor(int threads);
  ~Executor() { Stop(); }  // not from one of its own tasks

  // After Stop the task runs at once in the caller's thread: what waits for it is not left waiting.
  void Post(std::function<void()> task);
  // Returns when every task posted so far has run.
  void Stop();

 private:
  void Work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_EXECUTOR_H_
