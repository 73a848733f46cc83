// A worker that misbehaves as the request_id of its assignment says.
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/server/worker/worker_process.h"

namespace eyebox::service {
namespace {

// "0 1 2 3 ": what is open.
std::string OpenFiles() {
  std::string open;
  for (int fd = 0; fd < 256; ++fd) {
    if (fcntl(fd, F_GETFD) != -1) open += std::to_string(fd) + " ";
  }
  return open;
}

absl::Status TryWhatIsForbidden() {
  if (socket(AF_INET, SOCK_STREAM, 0) >= 0 || errno != EPERM) {
    return absl::FailedPreconditionError("a socket was opened");
  }
  char* const arguments[] = {nullptr};
  execv("/bin/true", arguments);
  return errno == EPERM ? absl::OkStatus() : absl::FailedPreconditionError("a program was started");
}

void EatMemory() {
  std::vector<std::vector<char>> eaten;
  for (;;) eaten.emplace_back(size_t{64} << 20, 'x');
}

absl::Status Misbehave(const Assignment& assignment, const Watcher& watcher) {
  const std::string& how = assignment.request.request_id();
  if (how == "segfault") raise(SIGSEGV);
  if (how == "abort") std::abort();
  if (how == "memory") EatMemory();
  if (how == "spin") {
    for (std::atomic<int> turns = 0;; ++turns) {
    }
  }
  if (how == "exit") _exit(7);
  if (how == "nonsense" && write(3, "P\1\2", 3) == 3) pause();
  if (how == "forbidden") return TryWhatIsForbidden();
  if (how == "refuse") return BadInput("frame 3", "is odd", "make it even");
  for (int step = 1; step <= 4; ++step) {
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(step / 4.0, "step " + std::to_string(step)));
  }
  return WriteFileAtomically(assignment.out / "files", OpenFiles());
}

}  // namespace
}  // namespace eyebox::service

int main() { return eyebox::service::ServeAssignment(eyebox::service::Misbehave); }
