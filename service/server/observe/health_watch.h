// Looks again and again whether the server should be asked for anything.
#ifndef EYEBOX_SERVICE_SERVER_OBSERVE_HEALTH_WATCH_H_
#define EYEBOX_SERVICE_SERVER_OBSERVE_HEALTH_WATCH_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace eyebox::service {

// What must hold while the server says SERVING.
struct HealthOptions {
  uint64_t min_free_bytes = 1'000'000'000;  // where data and state lie
  // Whether a capture waits for its camera longer than it should; empty: nobody can tell.
  std::function<bool()> recorder_stalled = {};
  std::chrono::milliseconds period = std::chrono::seconds(1);
};

// Free for the server on the fullest of the disks of `folders`; 0 if one cannot be asked.
uint64_t LeastFreeBytes(const std::vector<std::filesystem::path>& folders);

class HealthWatch {
 public:
  // Calls `tell` with what is wrong, empty if nothing: before this returns, and then, from a thread
  // of its own, whenever that begins or ends.
  HealthWatch(std::vector<std::filesystem::path> folders, HealthOptions options,
              std::function<void(const std::string& trouble)> tell);
  ~HealthWatch();  // `tell` is not called afterwards

 private:
  std::string Trouble() const;
  void Look();
  void Watch();

  const std::vector<std::filesystem::path> folders_;
  const HealthOptions options_;
  const std::function<void(const std::string&)> tell_;
  std::optional<bool> healthy_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_OBSERVE_HEALTH_WATCH_H_
