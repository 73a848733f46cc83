#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "capture/base/status.h"
#include "capture/trigger/line_trigger.h"

namespace eyebox::capture {
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(20);  // how fast the thread can be stopped
constexpr size_t kMaxWaiting = size_t{1} << 20;

class EdgeReader final : public EdgeSource {
 public:
  EdgeReader(std::string uri, std::unique_ptr<InputLine> line, EdgeKind kind, const Clock* clock)
      : uri_(std::move(uri)),
        line_(std::move(line)),
        kind_(kind),
        clock_(clock),
        opened_ns_(clock->MonotonicNs()),
        thread_([this](const std::stop_token& stop) { DrainUntilStopped(stop); }) {}

  absl::StatusOr<Edges> Take(std::chrono::milliseconds timeout) override {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return !waiting_.edges.empty() || !lost_.ok(); });
    if (waiting_.edges.empty() && !lost_.ok()) return lost_;
    Edges taken = std::exchange(waiting_, {});
    lock.unlock();
    EYEBOX_RETURN_IF_ERROR(CheckTimes(taken));
    return taken;
  }

 private:
  void DrainUntilStopped(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const absl::StatusOr<std::vector<Edge>> edges = line_->Read(kPollInterval);
      const std::lock_guard lock(mutex_);
      if (edges.ok()) Note(*edges);
      if (!edges.ok()) lost_ = edges.status();
      if (!lost_.ok() || !waiting_.edges.empty()) changed_.notify_all();
      if (!lost_.ok()) return;
    }
  }

  void Note(const std::vector<Edge>& edges) {
    if (edges.size() >= kKernelQueue) ++waiting_.full_queues;
    for (const Edge& edge : edges) {
      if (kind_ == EdgeKind::kBoth && last_rising_ == edge.rising) ++waiting_.known_losses;
      last_rising_ = edge.rising;
      waiting_.edges.push_back(edge);
    }
    if (waiting_.edges.size() <= kMaxWaiting) return;
    lost_ = DeviceFailed(uri_, "has more than a million edges that nobody took",
                         "take them more often, or check for a line that is not connected");
    waiting_ = {};
  }

  // Kernels before 5.7 stamp edges with the wall clock, which is decades ahead.
  absl::Status CheckTimes(const Edges& taken) const {
    const int64_t now_ns = clock_->MonotonicNs();
    for (const Edge& edge : taken.edges) {
      if (edge.monotonic_ns >= opened_ns_ && edge.monotonic_ns <= now_ns) continue;
      return DeviceFailed(uri_, "stamps edges with a clock that is not CLOCK_MONOTONIC",
                          "use Linux 5.7 or later");
    }
    return absl::OkStatus();
  }

  const std::string uri_;
  const std::unique_ptr<InputLine> line_;
  const EdgeKind kind_;
  const Clock* const clock_;
  const int64_t opened_ns_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Edges waiting_;
  std::optional<bool> last_rising_;
  absl::Status lost_;
  std::jthread thread_;  // last: it uses everything above
};

}  // namespace

std::unique_ptr<EdgeSource> MakeEdgeReader(std::string uri, std::unique_ptr<InputLine> line,
                                           EdgeKind kind, const Clock* clock) {
  return std::make_unique<EdgeReader>(std::move(uri), std::move(line), kind, clock);
}

}  // namespace eyebox::capture
