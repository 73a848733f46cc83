#include "service/server/worker/worker_process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <memory>
#include <utility>

#include "capture/base/status.h"
#include "service/server/store/beneath.h"
#include "service/server/store/names.h"
#include "service/server/worker/sandbox.h"
#include "service/server/worker/worker_link.h"

namespace eyebox::service {
namespace {

constexpr int kLinkFd = 3;  // of the worker
constexpr char kGoOn[] = "G";
constexpr char kStop[] = "S";

uint64_t AddressSpaceOf(const WorkerLimits& limits) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return RLIM_INFINITY;  // a sanitizer's shadow alone is terabytes
#endif
  if (limits.address_space_bytes != 0) return limits.address_space_bytes;
  return static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) / 4 * 3 *
         static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
}

struct Limit {
  __rlimit_resource resource;
  rlim_t value;
};

// Between fork and exec: only what a signal handler may call.
[[noreturn]] void BecomeWorker(const char* const* command, const Limit* limits, size_t limit_count,
                               int link, pid_t parent) {
  const auto fail = [] { _exit(127); };
  if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0 || getppid() != parent) fail();
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) fail();
  const int nothing = open("/dev/null", O_RDONLY);
  // Standard output is the server's own; a worker's goes where its errors go.
  if (nothing < 0 || dup2(nothing, 0) < 0 || dup2(2, 1) < 0) fail();
  if (link == kLinkFd ? fcntl(link, F_SETFD, 0) != 0 : dup2(link, kLinkFd) < 0) fail();
  if (close_range(kLinkFd + 1, ~0U, 0) != 0) fail();
  for (size_t i = 0; i < limit_count; ++i) {
    // At the soft limit of processor time comes SIGXCPU, which says so; at the hard one SIGKILL.
    const rlim_t grace = limits[i].resource == RLIMIT_CPU ? 1 : 0;
    const rlimit limit = {limits[i].value, limits[i].value + grace};
    if (setrlimit(limits[i].resource, &limit) != 0) fail();
  }
  execv(command[0], const_cast<char* const*>(command));
  fail();
  __builtin_unreachable();
}

absl::StatusOr<pid_t> Start(const std::vector<std::string>& command, const WorkerLimits& limits,
                            int link) {
  std::vector<const char*> arguments;
  for (const std::string& argument : command) arguments.push_back(argument.c_str());
  arguments.push_back(nullptr);
  const Limit table[] = {{RLIMIT_CORE, 0},
                         {RLIMIT_AS, AddressSpaceOf(limits)},
                         {RLIMIT_CPU, limits.cpu_s},
                         {RLIMIT_FSIZE, limits.file_bytes},
                         {RLIMIT_NOFILE, limits.open_files}};
  const pid_t parent = getpid();
  const pid_t worker = fork();
  if (worker == 0) BecomeWorker(arguments.data(), table, std::size(table), link, parent);
  if (worker < 0) return SystemFailed("worker", errno, "close other programs, then try again");
  return worker;
}

absl::Status EndOf(int wait_status) {
  constexpr char kRemedy[] =
      "check the recording with eyebox verify-files; another run may succeed";
  if (WIFSIGNALED(wait_status)) {
    const int signal = WTERMSIG(wait_status);
    if (signal == SIGXCPU) {
      return absl::ResourceExhaustedError(
          Complaint("worker", "the job used up its processor time", "ask for less at once"));
    }
    return Corrupt("worker",
                   std::string("the process that did the job was ended by signal ") +
                       std::to_string(signal) + " (" + strsignal(signal) + ")",
                   kRemedy);
  }
  return absl::InternalError(Complaint(
      "worker",
      "ended without a word, with exit status " + std::to_string(WEXITSTATUS(wait_status)),
      kRemedy));
}

// Answers the worker until it says how the work ended. Nothing: it went away or talks nonsense.
std::optional<absl::Status> Attend(int link, const Watcher& watcher) {
  for (;;) {
    const auto message = Receive(link);
    auto said = message.ok() ? DecodeWorker(*message) : std::nullopt;
    if (!said) return std::nullopt;
    if (auto* end = std::get_if<absl::Status>(&*said)) return std::move(*end);
    if (auto* progress = std::get_if<Progress>(&*said); progress && watcher.progress) {
      watcher.progress(*progress);
    }
    const bool stop = watcher.cancelled && watcher.cancelled();
    if (!Send(link, stop ? kStop : kGoOn).ok()) return std::nullopt;
  }
}

absl::Status Delegate(const std::vector<std::string>& command, const WorkerLimits& limits,
                      const Assignment& assignment, const Watcher& watcher) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
    return SystemFailed("worker", errno, "close other programs, then try again");
  }
  const OwnedFd ours(ends[0]);
  std::optional<OwnedFd> theirs(std::in_place, ends[1]);
  EYEBOX_ASSIGN_OR_RETURN(const pid_t worker, Start(command, limits, theirs->get()));
  theirs.reset();
  std::optional<absl::Status> end;
  if (Send(ours.get(), EncodeAssignment(assignment)).ok()) end = Attend(ours.get(), watcher);
  // It has nothing more to say; one that hangs or talks nonsense is not waited for.
  kill(worker, SIGKILL);
  int wait_status = 0;
  while (waitpid(worker, &wait_status, 0) < 0 && errno == EINTR) {
  }
  return end ? *end : EndOf(wait_status);
}

bool MayGoOn() {
  const auto answer = Receive(kLinkFd);
  return answer.ok() && *answer == kGoOn;
}

}  // namespace

Work MakeProcessWork(std::vector<std::string> command, const WorkerLimits& limits) {
  return
      [command = std::move(command), limits](const Assignment& assignment, const Watcher& watcher) {
        return Delegate(command, limits, assignment, watcher);
      };
}

int ServeAssignment(const Work& work) {
  const auto message = Receive(kLinkFd);
  const auto assignment = message.ok() ? DecodeAssignment(*message) : message.status();
  if (!assignment.ok()) return 1;
  bool stop = false;
  Watcher watcher;
  watcher.progress = [&stop](const Progress& progress) {
    stop = !Send(kLinkFd, EncodeProgress(progress)).ok() || !MayGoOn() || stop;
  };
  watcher.cancelled = [&stop] {
    stop = stop || !Send(kLinkFd, EncodeMayIGoOn()).ok() || !MayGoOn();
    return stop;
  };
  const absl::Status alone = LeaveTheNetwork();
  const absl::Status status = alone.ok() ? work(*assignment, watcher) : alone;
  return Send(kLinkFd, EncodeEnd(status)).ok() ? 0 : 1;
}

}  // namespace eyebox::service
