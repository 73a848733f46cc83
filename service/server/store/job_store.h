// Jobs on disk, one folder each, so that a job outlives the server.
//
//   <state>/lock                      held by the one server that uses the folder
//   <state>/jobs/<id>/request.json    what was asked for; written once
//   <state>/jobs/<id>/events.log      every event, the last one is the state (see event_log.h)
//   <state>/jobs/<id>/recording/      the frames of a rig
//   <state>/jobs/<id>/result.partial/ what the work writes into; renamed once it is complete
//   <state>/jobs/<id>/result/         the artifacts of a job that succeeded
#ifndef EYEBOX_SERVICE_SERVER_STORE_JOB_STORE_H_
#define EYEBOX_SERVICE_SERVER_STORE_JOB_STORE_H_

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "eyebox/v1/job_service.pb.h"
#include "eyebox/v1/service.pb.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

struct StoredJob {
  std::string id;  // "000001", "000002", ... in order of creation
  v1::CreateJobRequest request;
  std::vector<v1::JobEvent> events;  // one or more, unless damaged
  absl::Status damage;               // why it could not be read
};

// Thread-safe for different jobs; calls for one job must not overlap.
class JobStore {
 public:
  // Creates `state` if missing and locks it.
  // Errors: FailedPrecondition if another server uses it; the errno of the disk.
  static absl::StatusOr<std::unique_ptr<JobStore>> Open(const std::filesystem::path& state);

  // Oldest first. Removes what an interrupted Create left.
  absl::StatusOr<std::vector<StoredJob>> Load() const;

  // The job is there as a whole when it returns OK, and not at all otherwise.
  absl::Status Create(const StoredJob& job) const;
  absl::Status Append(const std::string& id, const v1::JobEvent& event) const;

  // Gives the work an empty place: no recording, no result, an empty result.partial.
  absl::Status Clear(const std::string& id) const;
  // Publishes result.partial as result; returns its files by name, with their digests.
  // Errors: Internal if it holds anything but files with names that clients may send.
  absl::StatusOr<std::vector<v1::Artifact>> PublishResult(const std::string& id) const;

  std::filesystem::path RecordingOf(const std::string& id) const;
  std::filesystem::path PartialResultOf(const std::string& id) const;
  std::filesystem::path ResultOf(const std::string& id) const;

 private:
  JobStore(std::filesystem::path jobs, OwnedFd lock)
      : jobs_(std::move(jobs)), lock_(std::move(lock)) {}

  std::filesystem::path jobs_;
  OwnedFd lock_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_JOB_STORE_H_
