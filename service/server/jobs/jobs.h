// Durable jobs: created, run, watched, cancelled; a restart loses none.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_JOBS_H_
#define EYEBOX_SERVICE_SERVER_JOBS_JOBS_H_

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "eyebox/v1/job_service.pb.h"
#include "eyebox/v1/service.pb.h"
#include "service/server/jobs/job_table.h"
#include "service/server/jobs/lanes.h"
#include "service/server/jobs/stimulus_desk.h"
#include "service/server/store/job_store.h"
#include "service/watcher.h"

namespace eyebox::service {

// What a job has to do and where.
struct Assignment {
  v1::CreateJobRequest request;
  std::filesystem::path recording;     // where a rig's frames go; does not exist yet
  std::filesystem::path out;           // exists and is empty; every file in it becomes an artifact
  bool started_before = false;         // by a server that was stopped: it may have left something
  std::shared_ptr<StimulusDesk> desk;  // where clients say what is shown; never null
};
using Work = std::function<absl::Status(const Assignment&, const Watcher&)>;

struct JobsOptions {
  int queue_limit = 64;     // jobs that wait
  int capture_threads = 4;  // rigs that capture at a time
  int max_attempts = 3;     // starts of one job before it counts as what stops the server
};

// Thread-safe. Calls marked "disk" wait for stable storage and do not belong in a reactor.
class Jobs {
 public:
  // Loads what the store holds; jobs that had not ended wait to run again. `clock` must outlive
  // the jobs. Errors: those of the store.
  static absl::StatusOr<std::unique_ptr<Jobs>> Open(std::unique_ptr<JobStore> store, Work work,
                                                    const Clock* clock, const JobsOptions& options);
  ~Jobs() { Stop(); }

  // Jobs wait, and none is created, until this is called.
  void Start();
  // Interrupts the job under way before its next step; it and those that wait run again after the
  // next start. Listeners are told.
  void Stop();
  bool stopping() const { return stopping_; }

  // Nothing if the request_id is new. Errors: AlreadyExists if it belongs to another request.
  absl::StatusOr<std::optional<v1::Job>> Existing(const v1::CreateJobRequest& request) const;
  // Disk. The request was validated. Gives the existing job if there is one.
  // Errors: AlreadyExists, ResourceExhausted, Unavailable, those of the store.
  absl::StatusOr<v1::Job> Create(const v1::CreateJobRequest& request);
  // Disk. A job that has ended stays as it is. Errors: NotFound, those of the store.
  absl::StatusOr<v1::Job> Cancel(int64_t number);

  JobTable& table() { return table_; }
  // Where clients meet the job. Errors: NotFound, FailedPrecondition (it does not capture, or has
  // ended), Unavailable (it waits for its turn, or the server stops).
  absl::StatusOr<std::shared_ptr<StimulusDesk>> DeskOf(int64_t number) const;
  std::filesystem::path ResultOf(int64_t number) const;

 private:
  using Change = std::function<void(v1::Job&)>;

  Jobs(std::unique_ptr<JobStore> store, Work work, const Clock* clock, const JobsOptions& options)
      : store_(std::move(store)), work_(std::move(work)), clock_(clock), options_(options) {}

  absl::Status Recover(const StoredJob& stored);
  absl::Status RecoverUnended(int64_t number, const v1::Job& job);
  void InsertDamaged(int64_t number, const StoredJob& stored);
  absl::Status CheckOpenForMore() const;

  void Post(int64_t number, const v1::CreateJobRequest& request);
  void Run(int64_t number);
  absl::Status Attempt(int64_t number);
  absl::Status AttemptAt(int64_t number, const std::shared_ptr<StimulusDesk>& desk);
  void End(int64_t number, const absl::Status& status);
  // Adds an event with the job as `change` leaves it, on disk and then in the table. One that has
  // ended, or that `change` leaves as it is, gets none.
  absl::StatusOr<v1::Job> Publish(int64_t number, const Change& change);
  void PublishInMemory(int64_t number, const Change& change);
  bool CancelRequested(int64_t number) const;

  const std::unique_ptr<JobStore> store_;
  const Work work_;
  const Clock* const clock_;
  const JobsOptions options_;
  JobTable table_;
  std::vector<int64_t> recovered_;
  std::mutex publishing_;  // orders events on disk as in the table
  std::atomic<bool> stopping_ = false;
  mutable std::mutex desks_mutex_;
  std::map<int64_t, std::shared_ptr<StimulusDesk>> desks_;  // of the jobs under way
  std::unique_ptr<Lanes> lanes_;                            // set by Start
};

// jobs/000001 and its number.
std::string JobName(int64_t number);
// Errors: InvalidArgument or NotFound naming `field`.
absl::StatusOr<int64_t> JobNumber(std::string_view field, std::string_view name);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_JOBS_H_
