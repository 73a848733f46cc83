#include "service/server/observe/health_watch.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

constexpr double kBytesPerGb = 1e9;

}  // namespace

uint64_t LeastFreeBytes(const std::vector<std::filesystem::path>& folders) {
  uint64_t least = UINT64_MAX;
  for (const std::filesystem::path& folder : folders) {
    std::error_code error;
    const auto space = std::filesystem::space(folder, error);
    least = std::min<uint64_t>(least, error ? 0 : space.available);
  }
  return least;
}

HealthWatch::HealthWatch(std::vector<std::filesystem::path> folders, HealthOptions options,
                         std::function<void(const std::string&)> tell)
    : folders_(std::move(folders)), options_(std::move(options)), tell_(std::move(tell)) {
  Look();
  thread_ = std::thread([this] { Watch(); });
}

HealthWatch::~HealthWatch() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::string HealthWatch::Trouble() const {
  const uint64_t free_bytes = LeastFreeBytes(folders_);
  if (free_bytes < options_.min_free_bytes) {
    return absl::StrFormat("the disk has %.3f GB left, less than %.3f GB",
                           static_cast<double>(free_bytes) / kBytesPerGb,
                           static_cast<double>(options_.min_free_bytes) / kBytesPerGb);
  }
  if (options_.recorder_stalled && options_.recorder_stalled()) return "the recorder stalls";
  return "";
}

void HealthWatch::Look() {
  const std::string trouble = Trouble();
  if (healthy_ != trouble.empty()) tell_(trouble);
  healthy_ = trouble.empty();
}

void HealthWatch::Watch() {
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, options_.period, [this] { return stopping_; })) {
    lock.unlock();
    Look();
    lock.lock();
  }
}

}  // namespace eyebox::service
