#include "service/server/store/event_log.h"

#include <errno.h>
#include <fcntl.h>
#include <google/protobuf/util/json_util.h>
#include <unistd.h>

#include <string>

#include "absl/strings/str_split.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {
namespace {

constexpr char kDiskRemedy[] = "make room on the disk of the state folder, and check its mode";

absl::Status WriteAll(int fd, const std::string& bytes) {
  size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t n = write(fd, bytes.data() + written, bytes.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return absl::ErrnoToStatus(n < 0 ? errno : ENOSPC, "write");
    written += static_cast<size_t>(n);
  }
  // A failed fdatasync is not tried again: the kernel may have dropped the pages.
  if (fdatasync(fd) != 0) return absl::ErrnoToStatus(errno, "fdatasync");
  return absl::OkStatus();
}

absl::Status Damaged(const std::filesystem::path& log, size_t line, const std::string& what) {
  return Corrupt(log.string() + ", line " + std::to_string(line), what,
                 "remove the job's folder, or restore it from a backup");
}

}  // namespace

absl::Status AppendEvent(const std::filesystem::path& log, const v1::JobEvent& event) {
  std::string line;
  const auto status = google::protobuf::util::MessageToJsonString(event, &line);
  if (!status.ok()) return absl::InternalError(status.ToString());
  line.push_back('\n');
  const OwnedFd fd(open(log.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0640));
  if (fd.get() < 0) return SystemFailed(log.string(), errno, kDiskRemedy);
  const off_t end = lseek(fd.get(), 0, SEEK_END);
  const absl::Status written = WriteAll(fd.get(), line);
  if (written.ok()) return absl::OkStatus();
  if (ftruncate(fd.get(), end) != 0) {
    return Corrupt(log.string(), "holds an event that could not be taken back", kDiskRemedy);
  }
  return absl::Status(written.code(),
                      Complaint(log.string(), std::string(written.message()), kDiskRemedy));
}

absl::StatusOr<std::vector<v1::JobEvent>> RecoverEvents(const std::filesystem::path& log) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(log));
  const size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (whole < text.size() && truncate(log.c_str(), static_cast<off_t>(whole)) != 0) {
    return SystemFailed(log.string(), errno, kDiskRemedy);
  }
  std::vector<v1::JobEvent> events;
  for (const absl::string_view line :
       absl::StrSplit(absl::string_view(text.data(), whole), '\n', absl::SkipEmpty())) {
    const size_t number = events.size() + 1;
    v1::JobEvent& event = events.emplace_back();
    const auto status =
        google::protobuf::util::JsonStringToMessage({line.data(), line.size()}, &event);
    if (!status.ok()) return Damaged(log, number, "is not an event in JSON");
    if (event.sequence() != number) return Damaged(log, number, "is out of sequence");
  }
  if (events.empty()) return Damaged(log, 1, "is missing");
  return events;
}

}  // namespace eyebox::service
