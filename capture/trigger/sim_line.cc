#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "capture/trigger/line.h"

namespace eyebox::capture {
namespace {

// The edges that one simulated input has not read yet.
class Queue {
 public:
  explicit Queue(EdgeKind kind) : kind_(kind) {}

  void Push(const Edge& edge) {
    if (kind_ == (edge.rising ? EdgeKind::kFalling : EdgeKind::kRising)) return;
    const std::lock_guard lock(mutex_);
    edges_.push_back(edge);
    changed_.notify_all();
  }

  std::vector<Edge> Take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return !edges_.empty(); });
    // One less than what a kernel's queue holds: this one never runs full.
    const auto count = std::min(edges_.size(), kKernelQueue - 1);
    std::vector<Edge> taken(edges_.begin(), edges_.begin() + count);
    edges_.erase(edges_.begin(), edges_.begin() + count);
    return taken;
  }

 private:
  const EdgeKind kind_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Edge> edges_;
};

// The wires of this process, by name.
class Wires {
 public:
  static Wires& Instance() {
    static Wires wires;
    return wires;
  }

  std::shared_ptr<Queue> Connect(const std::string& name, EdgeKind kind) {
    const std::lock_guard lock(mutex_);
    auto queue = std::make_shared<Queue>(kind);
    queues_.emplace(name, queue);
    return queue;
  }

  void Send(const std::string& name, const Edge& edge) {
    const std::lock_guard lock(mutex_);
    const auto [begin, end] = queues_.equal_range(name);
    for (auto at = begin; at != end;) {
      const std::shared_ptr<Queue> queue = at->second.lock();
      if (queue != nullptr) queue->Push(edge);
      at = queue == nullptr ? queues_.erase(at) : std::next(at);
    }
  }

 private:
  std::mutex mutex_;
  std::multimap<std::string, std::weak_ptr<Queue>> queues_;
};

class SimOutput final : public OutputLine {
 public:
  SimOutput(std::string name, const Clock* clock) : name_(std::move(name)), clock_(clock) {}
  ~SimOutput() override {
    if (on_) Wires::Instance().Send(name_, {clock_->MonotonicNs(), false});
  }

  absl::Status Set(bool on) override {
    if (on != on_) Wires::Instance().Send(name_, {clock_->MonotonicNs(), on});
    on_ = on;
    return absl::OkStatus();
  }

 private:
  const std::string name_;
  const Clock* const clock_;
  bool on_ = false;
};

class SimInput final : public InputLine {
 public:
  explicit SimInput(std::shared_ptr<Queue> queue) : queue_(std::move(queue)) {}
  absl::StatusOr<std::vector<Edge>> Read(std::chrono::milliseconds timeout) override {
    return queue_->Take(timeout);
  }

 private:
  const std::shared_ptr<Queue> queue_;
};

}  // namespace

std::unique_ptr<OutputLine> OpenSimOutput(const std::string& name, const Clock* clock) {
  return std::make_unique<SimOutput>(name, clock);
}

std::unique_ptr<InputLine> OpenSimInput(const std::string& name, EdgeKind kind) {
  return std::make_unique<SimInput>(Wires::Instance().Connect(name, kind));
}

}  // namespace eyebox::capture
