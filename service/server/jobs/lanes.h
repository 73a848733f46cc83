// The threads of the jobs: captures never wait for an analysis, and a rig serves one job at a time.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_LANES_H_
#define EYEBOX_SERVICE_SERVER_JOBS_LANES_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace eyebox::service {

// Thread-safe. Within a lane tasks run in the order in which they were posted, but for those whose
// rig is busy, which let others pass.
class Lanes {
 public:
  enum class Lane { kAnalysis, kCapture };
  struct Task {
    Lane lane = Lane::kAnalysis;
    std::string rig;  // no two tasks of one rig run at once; empty: uses none
    std::function<void()> run;
  };

  // One thread analyses, `capture_threads` capture. The analysis, with the threads that it starts,
  // gives way to captures where the processor is scarce.
  explicit Lanes(int capture_threads);
  ~Lanes() { Stop(); }  // not from one of its own tasks

  // After Stop nothing runs any more.
  void Post(Task task);
  // Returns when the tasks under way have ended. Those that wait are dropped.
  void Stop();

 private:
  void Work(Lane lane);
  // The first of the lane that may run, taken out; its rig is busy from now on.
  bool Take(Lane lane, Task& task);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Task> waiting_;
  std::set<std::string> busy_rigs_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_LANES_H_
