// What is known of every job, in memory: answers at once, so that reactors may ask it.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_JOB_TABLE_H_
#define EYEBOX_SERVICE_SERVER_JOBS_JOB_TABLE_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/job_service.pb.h"
#include "eyebox/v1/service.pb.h"

namespace eyebox::service {

bool HasEnded(const v1::Job& job);

// Called after an event of the job was added, or when the server stops; from any thread, perhaps
// several at once. It must return soon. It may still be called shortly after it was removed.
using Listener = std::function<void()>;

// Thread-safe; holds no lock while it calls listeners. Errors of all calls: NotFound.
class JobTable {
 public:
  void Insert(int64_t number, const v1::CreateJobRequest& request,
              std::vector<v1::JobEvent> events);
  void Append(int64_t number, const v1::JobEvent& event);

  absl::StatusOr<v1::Job> Latest(int64_t number) const;
  absl::StatusOr<v1::CreateJobRequest> Request(int64_t number) const;
  // Nothing if the job has not come so far yet.
  absl::StatusOr<std::optional<v1::JobEvent>> Event(int64_t number, uint32_t sequence) const;
  // Nothing if no job was created with it.
  std::optional<int64_t> WithRequestId(const std::string& request_id) const;
  // At most `count` jobs older than `before`, newest first.
  std::vector<v1::Job> Page(int64_t before, int count) const;
  int CountOf(v1::JobState state) const;
  // One above the newest.
  int64_t NextNumber() const;

  absl::StatusOr<uint64_t> AddListener(int64_t number, Listener listener);
  void RemoveListener(int64_t number, uint64_t id);
  // Calls every listener of the job.
  void Notify(int64_t number) const;
  // Calls every listener of every job.
  void NotifyAll() const;

 private:
  struct Entry {
    v1::CreateJobRequest request;
    std::vector<v1::JobEvent> events;  // never empty; [i] has sequence i + 1
    std::map<uint64_t, std::shared_ptr<const Listener>> listeners;
  };
  absl::StatusOr<const Entry*> Find(int64_t number) const;

  mutable std::mutex mutex_;
  std::map<int64_t, Entry> entries_;
  std::unordered_map<std::string, int64_t> by_request_id_;
  uint64_t next_listener_ = 1;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_JOB_TABLE_H_
