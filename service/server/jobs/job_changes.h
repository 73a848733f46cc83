// The steps of a job's life, as changes of its message.
#ifndef EYEBOX_SERVICE_SERVER_JOBS_JOB_CHANGES_H_
#define EYEBOX_SERVICE_SERVER_JOBS_JOB_CHANGES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "eyebox/v1/service.pb.h"
#include "service/watcher.h"

namespace eyebox::service {

v1::Job NewJob(const std::string& name, const std::string& request_id, int64_t real_ns);

void MarkStarted(v1::Job& job);
void MarkProgress(const Progress& progress, v1::Job& job);
// Back in the queue after the server was killed, or after an orderly stop, which does not count as
// an attempt.
void MarkKilled(v1::Job& job);
void MarkInterrupted(v1::Job& job);
// One that waits ends at once.
void MarkCancelRequested(int64_t real_ns, v1::Job& job);
void MarkSucceeded(const std::vector<v1::Artifact>& artifacts, int64_t real_ns, v1::Job& job);
// Cancelled if someone asked for it and that is what the status says, failed otherwise.
void MarkStopped(const absl::Status& status, int64_t real_ns, v1::Job& job);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_JOBS_JOB_CHANGES_H_
