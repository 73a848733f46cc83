#include "service/server/jobs/jobs.h"

#include <google/protobuf/util/message_differencer.h>

#include <cstdio>
#include <utility>

#include "absl/strings/numbers.h"
#include "capture/base/status.h"
#include "service/server/jobs/job_changes.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

// Bounds the events of one attempt: 200.
constexpr double kProgressStep = 0.005;
// Steps of a capture job are numbered from the newest event on: above those of every attempt
// before, however the server stopped. No plan has so many captures.
constexpr uint64_t kStepsOfAnEvent = 1'000'000;

// The events of a job that starts for the first time: created, started.
constexpr uint32_t kFirstStart = 2;

// What a job holds while it runs. A rig file is as good as its camera: two that name one camera
// meet at the device, which serves one.
std::string RigOf(const v1::CreateJobRequest& request) {
  if (request.run().has_rig()) return request.run().rig().camera_uri();
  if (!request.has_capture()) return "";
  return request.capture().has_simulated() ? request.capture().simulated().camera_uri()
                                           : request.capture().rig();
}

std::string IdOf(int64_t number) { return JobName(number).substr(kJobRule.prefix.size()); }

v1::JobEvent EventOf(const v1::Job& job) {
  v1::JobEvent event;
  event.set_sequence(job.last_sequence());
  *event.mutable_job() = job;
  return event;
}

}  // namespace

std::string JobName(int64_t number) {
  char name[32];
  std::snprintf(name, sizeof(name), "jobs/%06lld", static_cast<long long>(number));
  return name;
}

absl::StatusOr<int64_t> JobNumber(std::string_view field, std::string_view name) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string id, CheckName(kJobRule, field, name));
  int64_t number = 0;
  if (!absl::SimpleAtoi(id, &number) || number < 1 || JobName(number) != name) {
    return WithField(Missing(field, "there is no job " + id, "list the jobs to see their names"),
                     field);
  }
  return number;
}

absl::StatusOr<std::unique_ptr<Jobs>> Jobs::Open(std::unique_ptr<JobStore> store, Work work,
                                                 const Clock* clock, const JobsOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<StoredJob> stored, store->Load());
  std::unique_ptr<Jobs> jobs(new Jobs(std::move(store), std::move(work), clock, options));
  for (const StoredJob& job : stored) EYEBOX_RETURN_IF_ERROR(jobs->Recover(job));
  return jobs;
}

absl::Status Jobs::Recover(const StoredJob& stored) {
  const auto number = JobNumber("jobs", std::string(kJobRule.prefix) + stored.id);
  if (!number.ok()) return absl::OkStatus();  // a folder that is none of ours
  if (!stored.damage.ok()) {
    InsertDamaged(*number, stored);
    return absl::OkStatus();
  }
  table_.Insert(*number, stored.request, stored.events);
  const v1::Job& job = stored.events.back().job();
  return HasEnded(job) ? absl::OkStatus() : RecoverUnended(*number, job);
}

absl::Status Jobs::RecoverUnended(int64_t number, const v1::Job& job) {
  if (job.cancel_requested()) {
    End(number, absl::CancelledError("cancelled before the server stopped"));
    return absl::OkStatus();
  }
  if (job.state() == v1::JOB_STATE_RUNNING) {
    if (job.attempts() >= options_.max_attempts) {
      End(number,
          absl::AbortedError(Complaint(
              job.name(),
              "the server was stopped " + std::to_string(job.attempts()) + " times while it ran",
              "check memory, disk and the recording's files, then create it again")));
      return absl::OkStatus();
    }
    EYEBOX_RETURN_IF_ERROR(Publish(number, MarkKilled).status());
  }
  recovered_.push_back(number);
  return absl::OkStatus();
}

void Jobs::InsertDamaged(int64_t number, const StoredJob& stored) {
  v1::Job job = NewJob(JobName(number), stored.request.request_id(), clock_->RealNs());
  job.set_last_sequence(1);
  MarkStopped(stored.damage, clock_->RealNs(), job);
  table_.Insert(number, stored.request, {EventOf(job)});
}

void Jobs::Start() {
  const std::lock_guard lock(publishing_);
  lanes_ = std::make_unique<Lanes>(options_.capture_threads);
  for (const int64_t number : std::exchange(recovered_, {})) {
    const auto request = table_.Request(number);
    if (request.ok()) Post(number, *request);
  }
}

void Jobs::Stop() {
  {
    const std::lock_guard lock(publishing_);
    stopping_ = true;
  }
  if (lanes_) lanes_->Stop();
  table_.NotifyAll();
}

absl::StatusOr<std::optional<v1::Job>> Jobs::Existing(const v1::CreateJobRequest& request) const {
  const auto number = table_.WithRequestId(request.request_id());
  if (!number) return std::nullopt;
  EYEBOX_ASSIGN_OR_RETURN(const v1::CreateJobRequest first, table_.Request(*number));
  if (!google::protobuf::util::MessageDifferencer::Equals(first, request)) {
    return WithField(
        absl::AlreadyExistsError(Complaint(
            "request_id",
            Quoted(request.request_id()) + " created " + JobName(*number) + " from another request",
            "give a request_id of its own to every run")),
        "request_id");
  }
  return table_.Latest(*number);
}

absl::Status Jobs::CheckOpenForMore() const {
  if (!lanes_ || stopping_) {
    return absl::UnavailableError(
        Complaint("server", stopping_ ? "is stopping" : "is starting",
                  "create the run again, with the same request_id, once it is up"));
  }
  if (table_.CountOf(v1::JOB_STATE_QUEUED) >= options_.queue_limit) {
    return absl::ResourceExhaustedError(
        Complaint("queue", std::to_string(options_.queue_limit) + " jobs wait already",
                  "create the run again once one of them has ended"));
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::Job> Jobs::Create(const v1::CreateJobRequest& request) {
  const std::lock_guard lock(publishing_);
  EYEBOX_ASSIGN_OR_RETURN(const auto existing, Existing(request));
  if (existing) return *existing;
  EYEBOX_RETURN_IF_ERROR(CheckOpenForMore());
  const int64_t number = table_.NextNumber();
  v1::Job job = NewJob(JobName(number), request.request_id(), clock_->RealNs());
  job.set_last_sequence(1);
  const StoredJob stored = {IdOf(number), request, {EventOf(job)}, absl::OkStatus()};
  EYEBOX_RETURN_IF_ERROR(store_->Create(stored));
  table_.Insert(number, request, stored.events);
  Post(number, request);
  return job;
}

absl::StatusOr<v1::Job> Jobs::Cancel(int64_t number) {
  return Publish(number, [this](v1::Job& job) { MarkCancelRequested(clock_->RealNs(), job); });
}

std::filesystem::path Jobs::ResultOf(int64_t number) const {
  return store_->ResultOf(IdOf(number));
}

bool Jobs::CancelRequested(int64_t number) const {
  const auto job = table_.Latest(number);
  return job.ok() && job->cancel_requested();
}

absl::StatusOr<std::shared_ptr<StimulusDesk>> Jobs::DeskOf(int64_t number) const {
  EYEBOX_ASSIGN_OR_RETURN(const v1::CreateJobRequest request, table_.Request(number));
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job job, table_.Latest(number));
  if (!request.has_capture() || HasEnded(job)) {
    return WithField(
        Rejected("name", HasEnded(job) ? "the job has ended" : "the job does not capture",
                 "create a capture job"),
        "name");
  }
  const std::lock_guard lock(desks_mutex_);
  const auto desk = desks_.find(number);
  if (desk != desks_.end() && !stopping_) return desk->second;
  return absl::UnavailableError(
      Complaint("name", stopping_ ? "the server is stopping" : "the job waits for its turn",
                "ask again in a moment"));
}

void Jobs::Post(int64_t number, const v1::CreateJobRequest& request) {
  lanes_->Post({.lane = request.has_capture() ? Lanes::Lane::kCapture : Lanes::Lane::kAnalysis,
                .rig = RigOf(request),
                .run = [this, number] { Run(number); }});
}

void Jobs::Run(int64_t number) {
  if (stopping_) return;
  const auto started = Publish(number, MarkStarted);
  if (started.ok() && HasEnded(*started)) return;  // cancelled while it waited
  const absl::Status status = started.ok() ? Attempt(number) : started.status();
  if (status.ok()) return;
  if (stopping_ && absl::IsCancelled(status) && !CancelRequested(number)) {
    // If the disk refuses this, the next start finds the job running, and that is as good.
    (void)Publish(number, MarkInterrupted);
    return;
  }
  End(number, status);
}

absl::Status Jobs::Attempt(int64_t number) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job job, table_.Latest(number));
  const auto desk = std::make_shared<StimulusDesk>(job.last_sequence() * kStepsOfAnEvent,
                                                   [this, number] { table_.Notify(number); });
  {
    const std::lock_guard lock(desks_mutex_);
    desks_[number] = desk;
  }
  const absl::Status status = AttemptAt(number, desk);
  {
    const std::lock_guard lock(desks_mutex_);
    desks_.erase(number);
  }
  desk->Close(status.ok() || absl::IsCancelled(status)
                  ? absl::UnavailableError(
                        Complaint("name", "the job does not capture any more", "see its state"))
                  : status);
  return status;
}

absl::Status Jobs::AttemptAt(int64_t number, const std::shared_ptr<StimulusDesk>& desk) {
  const std::string id = IdOf(number);
  EYEBOX_ASSIGN_OR_RETURN(const v1::CreateJobRequest request, table_.Request(number));
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job begun, table_.Latest(number));
  EYEBOX_RETURN_IF_ERROR(store_->Clear(id));
  absl::Status disk;
  double published = 0;
  Watcher watcher;
  watcher.cancelled = [&] { return stopping_ || !disk.ok() || CancelRequested(number); };
  watcher.progress = [&](const Progress& progress) {
    if (!disk.ok() || progress.fraction < published + kProgressStep) return;
    published = progress.fraction;
    disk = Publish(number, [&](v1::Job& job) { MarkProgress(progress, job); }).status();
  };
  const absl::Status worked = work_({.request = request,
                                     .recording = store_->RecordingOf(id),
                                     .out = store_->PartialResultOf(id),
                                     .started_before = begun.last_sequence() > kFirstStart,
                                     .desk = desk},
                                    watcher);
  EYEBOX_RETURN_IF_ERROR(disk);
  EYEBOX_RETURN_IF_ERROR(worked);
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<v1::Artifact> artifacts, store_->PublishResult(id));
  return Publish(number, [&](v1::Job& job) { MarkSucceeded(artifacts, clock_->RealNs(), job); })
      .status();
}

void Jobs::End(int64_t number, const absl::Status& status) {
  const auto stop_with = [&](const absl::Status& why) {
    return [this, why](v1::Job& job) { MarkStopped(why, clock_->RealNs(), job); };
  };
  const auto ended = Publish(number, stop_with(status));
  // Whoever waits must hear of it; after a restart the job runs again.
  if (!ended.ok()) PublishInMemory(number, stop_with(ended.status()));
}

absl::StatusOr<v1::Job> Jobs::Publish(int64_t number, const Change& change) {
  const std::lock_guard lock(publishing_);
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job before, table_.Latest(number));
  v1::Job job = before;
  change(job);
  if (HasEnded(before) || google::protobuf::util::MessageDifferencer::Equals(before, job)) {
    return before;
  }
  job.set_last_sequence(before.last_sequence() + 1);
  EYEBOX_RETURN_IF_ERROR(store_->Append(IdOf(number), EventOf(job)));
  table_.Append(number, EventOf(job));
  return job;
}

void Jobs::PublishInMemory(int64_t number, const Change& change) {
  const std::lock_guard lock(publishing_);
  absl::StatusOr<v1::Job> job = table_.Latest(number);
  if (!job.ok()) return;
  change(*job);
  job->set_last_sequence(job->last_sequence() + 1);
  table_.Append(number, EventOf(*job));
}

}  // namespace eyebox::service
