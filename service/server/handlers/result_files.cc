#include "service/server/handlers/result_files.h"

#include <errno.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "capture/base/status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr char kDiskRemedy[] = "check the disk of the state folder, then create the run again";

std::string NameOf(const v1::Job& job) {
  std::string state = v1::JobState_Name(job.state());
  return state.substr(std::string("JOB_STATE_").size());
}

}  // namespace

absl::StatusOr<v1::Job> SucceededJob(Jobs& jobs, const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", name));
  EYEBOX_ASSIGN_OR_RETURN(v1::Job job, jobs.table().Latest(number));
  if (job.state() == v1::JOB_STATE_SUCCEEDED) return job;
  return WithField(Rejected("name", name + " has no result: it is " + NameOf(job),
                            HasEnded(job) ? "see its error_message, then create another run"
                                          : "wait for it with WaitJob or WatchJob"),
                   "name");
}

absl::StatusOr<ResultFile> ResultFile::Open(Jobs& jobs, const std::string& job_name,
                                            const std::string& artifact) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::Job job, SucceededJob(jobs, job_name));
  EYEBOX_ASSIGN_OR_RETURN(const std::string file, CheckName(kArtifactRule, "artifact", artifact));
  const auto& all = job.artifacts();
  const auto listed = std::find_if(all.begin(), all.end(),
                                   [&](const v1::Artifact& one) { return one.name() == file; });
  if (listed == all.end()) {
    return WithField(Missing("artifact", file + " is no file of " + job_name,
                             "give the name of one of the job's artifacts"),
                     "artifact");
  }
  EYEBOX_ASSIGN_OR_RETURN(const int64_t number, JobNumber("name", job_name));
  EYEBOX_ASSIGN_OR_RETURN(const RootFolder folder, RootFolder::Open(jobs.ResultOf(number)));
  EYEBOX_ASSIGN_OR_RETURN(OwnedFd fd, folder.OpenFile(file));
  return ResultFile(*listed, std::move(fd));
}

absl::StatusOr<v1::ArtifactChunk> ResultFile::Read(uint64_t offset, uint64_t limit_bytes) const {
  const uint64_t total = artifact_.size_bytes();
  if (offset > total) {
    return WithField(absl::OutOfRangeError(
                         Complaint("offset",
                                   std::to_string(offset) + " is beyond the end of " +
                                       artifact_.name() + ", " + std::to_string(total) + " bytes",
                                   "give an offset within the file")),
                     "offset");
  }
  v1::ArtifactChunk chunk;
  chunk.set_offset(offset);
  chunk.set_total_bytes(total);
  chunk.set_sha256(artifact_.sha256());
  std::string& data = *chunk.mutable_data();
  data.resize(std::min({limit_bytes, kMaxChunkBytes, total - offset}));
  for (size_t done = 0; done < data.size();) {
    const ssize_t n =
        pread(fd_.get(), data.data() + done, data.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return SystemFailed(artifact_.name(), errno, kDiskRemedy);
    if (n == 0) return Corrupt(artifact_.name(), "is shorter than it was", kDiskRemedy);
    done += static_cast<size_t>(n);
  }
  return chunk;
}

}  // namespace eyebox::service
