#include "service/server/store/job_store.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/artifacts.h"
#include "service/result_json.h"
#include "service/server/store/event_log.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr char kNew[] = ".new";
constexpr char kRequest[] = "request.json";
constexpr char kEvents[] = "events.log";
constexpr char kRemedy[] = "give the server a state folder that it can write to";

absl::Status Failed(const fs::path& path, const std::error_code& error) {
  return SystemFailed(path.string(), error.value(), kRemedy);
}

absl::Status SyncFolder(const fs::path& folder) {
  const OwnedFd fd(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0 || fsync(fd.get()) != 0) return SystemFailed(folder.string(), errno, kRemedy);
  return absl::OkStatus();
}

absl::Status CreateFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  return error ? Failed(folder, error) : absl::OkStatus();
}

// As the socket: what clients measured is for owner and group.
absl::Status CloseToOthers(const fs::path& folder) {
  std::error_code error;
  fs::permissions(folder, fs::perms::others_all, fs::perm_options::remove, error);
  return error ? Failed(folder, error) : absl::OkStatus();
}

absl::Status Remove(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  return error ? Failed(path, error) : absl::OkStatus();
}

// Durable: also the name is on stable storage.
absl::Status Publish(const fs::path& from, const fs::path& to) {
  EYEBOX_RETURN_IF_ERROR(SyncFolder(from));
  std::error_code error;
  fs::rename(from, to, error);
  if (error) return Failed(to, error);
  return SyncFolder(to.parent_path());
}

absl::StatusOr<v1::Artifact> Describe(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!fs::is_regular_file(fs::symlink_status(file)) ||
      !CheckName(kArtifactRule, "artifact", name).ok()) {
    return absl::InternalError(Complaint(Quoted(name), "is no file that a client could ask for",
                                         "report this as a fault of the program"));
  }
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, size_t{4} << 30));
  v1::Artifact artifact;
  artifact.set_name(name);
  artifact.set_size_bytes(bytes.size());
  artifact.set_sha256(Sha256(bytes));
  return artifact;
}

// Before there was other work than runs, the request for a run stood there by itself.
absl::Status ReadRequest(const fs::path& file, v1::CreateJobRequest& request) {
  const absl::Status read = ReadJson(file, request);
  v1::CreateRunRequest run;
  if (read.ok() || !ReadJson(file, run).ok()) return read;
  request.Clear();
  request.set_request_id(run.request_id());
  run.clear_request_id();
  *request.mutable_run() = std::move(run);
  return absl::OkStatus();
}

StoredJob LoadJob(const fs::path& folder) {
  StoredJob job;
  job.id = folder.filename().string();
  job.damage = ReadRequest(folder / kRequest, job.request);
  if (!job.damage.ok()) return job;
  auto events = RecoverEvents(folder / kEvents);
  job.damage = events.status();
  if (events.ok()) job.events = *std::move(events);
  return job;
}

}  // namespace

absl::StatusOr<std::unique_ptr<JobStore>> JobStore::Open(const fs::path& state) {
  std::error_code error;
  const bool is_new = !fs::exists(state, error);
  EYEBOX_RETURN_IF_ERROR(CreateFolder(state / "jobs"));
  if (is_new) EYEBOX_RETURN_IF_ERROR(CloseToOthers(state));
  OwnedFd lock(open((state / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640));
  if (lock.get() < 0) return SystemFailed((state / "lock").string(), errno, kRemedy);
  if (flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    return Rejected(state.string(), "is in use by another server",
                    "stop that server or give this one its own --state folder");
  }
  return std::unique_ptr<JobStore>(new JobStore(state / "jobs", std::move(lock)));
}

absl::StatusOr<std::vector<StoredJob>> JobStore::Load() const {
  EYEBOX_RETURN_IF_ERROR(Remove(jobs_ / kNew));
  std::vector<StoredJob> jobs;
  std::error_code error;
  for (fs::directory_iterator entry(jobs_, error); !error && entry != fs::end(entry);
       entry.increment(error)) {
    jobs.push_back(LoadJob(entry->path()));
  }
  if (error) return Failed(jobs_, error);
  // By number: a longer id is a later one.
  std::sort(jobs.begin(), jobs.end(), [](const StoredJob& a, const StoredJob& b) {
    return std::pair(a.id.size(), a.id) < std::pair(b.id.size(), b.id);
  });
  return jobs;
}

absl::Status JobStore::Create(const StoredJob& job) const {
  EYEBOX_RETURN_IF_ERROR(Remove(jobs_ / kNew));
  EYEBOX_RETURN_IF_ERROR(CreateFolder(jobs_ / kNew));
  EYEBOX_ASSIGN_OR_RETURN(const std::string request, ToJson(job.request));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(jobs_ / kNew / kRequest, request));
  for (const v1::JobEvent& event : job.events) {
    EYEBOX_RETURN_IF_ERROR(AppendEvent(jobs_ / kNew / kEvents, event));
  }
  return Publish(jobs_ / kNew, jobs_ / job.id);
}

absl::Status JobStore::Append(const std::string& id, const v1::JobEvent& event) const {
  return AppendEvent(jobs_ / id / kEvents, event);
}

absl::Status JobStore::Clear(const std::string& id) const {
  EYEBOX_RETURN_IF_ERROR(Remove(RecordingOf(id)));
  EYEBOX_RETURN_IF_ERROR(Remove(ResultOf(id)));
  EYEBOX_RETURN_IF_ERROR(Remove(PartialResultOf(id)));
  return CreateFolder(PartialResultOf(id));
}

absl::StatusOr<std::vector<v1::Artifact>> JobStore::PublishResult(const std::string& id) const {
  std::vector<v1::Artifact> artifacts;
  std::error_code error;
  for (fs::directory_iterator entry(PartialResultOf(id), error); !error && entry != fs::end(entry);
       entry.increment(error)) {
    EYEBOX_ASSIGN_OR_RETURN(v1::Artifact artifact, Describe(entry->path()));
    artifacts.push_back(std::move(artifact));
  }
  if (error) return Failed(PartialResultOf(id), error);
  std::sort(artifacts.begin(), artifacts.end(),
            [](const v1::Artifact& a, const v1::Artifact& b) { return a.name() < b.name(); });
  EYEBOX_RETURN_IF_ERROR(Publish(PartialResultOf(id), ResultOf(id)));
  return artifacts;
}

fs::path JobStore::RecordingOf(const std::string& id) const { return jobs_ / id / "recording"; }
fs::path JobStore::PartialResultOf(const std::string& id) const {
  return jobs_ / id / "result.partial";
}
fs::path JobStore::ResultOf(const std::string& id) const { return jobs_ / id / "result"; }

}  // namespace eyebox::service
