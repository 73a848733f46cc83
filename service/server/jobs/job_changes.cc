#include "service/server/jobs/job_changes.h"

#include <google/protobuf/util/time_util.h>

namespace eyebox::service {
namespace {

using google::protobuf::util::TimeUtil;

void MarkEnded(v1::JobState state, const std::string& step, int64_t real_ns, v1::Job& job) {
  job.set_state(state);
  job.set_step(step);
  *job.mutable_end_time() = TimeUtil::NanosecondsToTimestamp(real_ns);
}

}  // namespace

v1::Job NewJob(const std::string& name, const std::string& request_id, int64_t real_ns) {
  v1::Job job;
  job.set_name(name);
  job.set_request_id(request_id);
  job.set_state(v1::JOB_STATE_QUEUED);
  job.set_step("waits for its turn");
  *job.mutable_create_time() = TimeUtil::NanosecondsToTimestamp(real_ns);
  return job;
}

void MarkStarted(v1::Job& job) {
  job.set_state(v1::JOB_STATE_RUNNING);
  job.set_attempts(job.attempts() + 1);
  job.set_progress(0);
  job.set_step("starts");
}

void MarkProgress(const Progress& progress, v1::Job& job) {
  job.set_progress(progress.fraction);
  job.set_step(progress.step);
}

void MarkKilled(v1::Job& job) {
  job.set_state(v1::JOB_STATE_QUEUED);
  job.set_progress(0);
  job.set_step("waits to run again: the server had stopped");
}

void MarkInterrupted(v1::Job& job) {
  MarkKilled(job);
  job.set_attempts(job.attempts() - 1);
  job.set_step("waits for the server to start again");
}

void MarkCancelRequested(int64_t real_ns, v1::Job& job) {
  job.set_cancel_requested(true);
  if (job.state() == v1::JOB_STATE_QUEUED) {
    MarkStopped(absl::CancelledError("cancelled before it started"), real_ns, job);
  }
}

void MarkSucceeded(const std::vector<v1::Artifact>& artifacts, int64_t real_ns, v1::Job& job) {
  job.set_progress(1);
  *job.mutable_artifacts() = {artifacts.begin(), artifacts.end()};
  MarkEnded(v1::JOB_STATE_SUCCEEDED, "done", real_ns, job);
}

void MarkStopped(const absl::Status& status, int64_t real_ns, v1::Job& job) {
  if (absl::IsCancelled(status) && job.cancel_requested()) {
    MarkEnded(v1::JOB_STATE_CANCELLED, "cancelled", real_ns, job);
    return;
  }
  job.set_error_code(static_cast<int>(status.code()));
  job.set_error_message(std::string(status.message()));
  MarkEnded(v1::JOB_STATE_FAILED, "failed", real_ns, job);
}

}  // namespace eyebox::service
