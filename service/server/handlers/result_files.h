// The files of a job that succeeded, opened beneath its result folder.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_RESULT_FILES_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_RESULT_FILES_H_

#include <cstdint>
#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/service.pb.h"
#include "service/server/jobs/jobs.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

inline constexpr uint64_t kMaxChunkBytes = uint64_t{1} << 20;
// Leaves room for the rest of the message below clients' limits.
inline constexpr uint64_t kStreamChunkBytes = uint64_t{512} << 10;

// Errors: InvalidArgument, NotFound, FailedPrecondition (not succeeded), with the field.
absl::StatusOr<v1::Job> SucceededJob(Jobs& jobs, const std::string& name);

// One artifact, open for reading. Waits for the disk.
class ResultFile {
 public:
  // Errors: also NotFound (no such artifact), DataLoss (not as large as it was).
  static absl::StatusOr<ResultFile> Open(Jobs& jobs, const std::string& job,
                                         const std::string& artifact);

  const v1::Artifact& artifact() const { return artifact_; }
  // Leads to it while this lives.
  std::filesystem::path path() const { return fd_.Path(); }
  // At most `limit_bytes` from `offset`, shorter only at the end of the file.
  // Errors: OutOfRange if `offset` is beyond the end; DataLoss, the errno of the disk.
  absl::StatusOr<v1::ArtifactChunk> Read(uint64_t offset, uint64_t limit_bytes) const;

 private:
  ResultFile(v1::Artifact artifact, OwnedFd fd)
      : artifact_(std::move(artifact)), fd_(std::move(fd)) {}

  v1::Artifact artifact_;
  OwnedFd fd_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_RESULT_FILES_H_
