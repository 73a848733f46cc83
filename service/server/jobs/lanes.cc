#include "service/server/jobs/lanes.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

namespace eyebox::service {
namespace {

constexpr int kAnalysisNice = 5;

// Of this thread, and of those that it starts. Refused, the analysis is as urgent as a capture,
// which costs time and no frame.
void GiveWay() { (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kAnalysisNice); }

}  // namespace

Lanes::Lanes(int capture_threads) {
  threads_.emplace_back([this] {
    GiveWay();
    Work(Lane::kAnalysis);
  });
  for (int i = 0; i < capture_threads; ++i) {
    threads_.emplace_back([this] { Work(Lane::kCapture); });
  }
}

void Lanes::Post(Task task) {
  const std::lock_guard lock(mutex_);
  if (stopping_) return;
  waiting_.push_back(std::move(task));
  changed_.notify_all();
}

void Lanes::Stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

bool Lanes::Take(Lane lane, Task& task) {
  const auto free = std::ranges::find_if(
      waiting_, [&](const Task& one) { return one.lane == lane && !busy_rigs_.contains(one.rig); });
  if (free == waiting_.end()) return false;
  task = std::move(*free);
  waiting_.erase(free);
  if (!task.rig.empty()) busy_rigs_.insert(task.rig);
  return true;
}

void Lanes::Work(Lane lane) {
  std::unique_lock lock(mutex_);
  while (true) {
    Task task;
    changed_.wait(lock, [&] { return stopping_ || Take(lane, task); });
    if (!task.run) return;
    lock.unlock();
    task.run();
    task.run = nullptr;
    lock.lock();
    busy_rigs_.erase(task.rig);
    changed_.notify_all();
  }
}

}  // namespace eyebox::service
