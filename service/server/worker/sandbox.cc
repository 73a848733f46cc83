#include "service/server/worker/sandbox.h"

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstddef>
#include <vector>

#include "capture/base/status.h"

namespace eyebox::service {
namespace {

#if defined(__x86_64__)
constexpr uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#else
#error "say which AUDIT_ARCH this machine is"
#endif

constexpr long kDenied[] = {
    SYS_socket,    SYS_connect,     SYS_bind,        SYS_listen,          SYS_accept,
    SYS_accept4,   SYS_execve,      SYS_execveat,    SYS_ptrace,          SYS_process_vm_readv,
    SYS_mount,     SYS_umount2,     SYS_pivot_root,  SYS_chroot,          SYS_unshare,
    SYS_setns,     SYS_bpf,         SYS_init_module, SYS_finit_module,    SYS_process_vm_writev,
    SYS_add_key,   SYS_request_key, SYS_keyctl,      SYS_perf_event_open, SYS_userfaultfd,
    SYS_kexec_load};
// Numbers from here on are the calls of x32, which would pass by the list.
constexpr uint32_t kX32Bit = 0x40000000;

std::vector<sock_filter> Filter() {
  const auto load = [](size_t offset) {
    return sock_filter(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<uint32_t>(offset)));
  };
  const sock_filter refuse = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM);
  std::vector<sock_filter> filter = {load(offsetof(seccomp_data, arch)),
                                     BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0),
                                     BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
                                     load(offsetof(seccomp_data, nr)),
                                     BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kX32Bit, 0, 1),
                                     refuse};
  for (const long call : kDenied) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<uint32_t>(call), 0, 1));
    filter.push_back(refuse);
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  return filter;
}

}  // namespace

absl::Status LeaveTheNetwork() {
  std::vector<sock_filter> filter = Filter();
  const sock_fprog program = {static_cast<unsigned short>(filter.size()), filter.data()};
  // TSYNC: threads that libraries started before this are bound too.
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
      syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) == 0) {
    return absl::OkStatus();
  }
  return absl::UnimplementedError(Complaint(
      "worker", "the kernel has no seccomp filters, so foreign data cannot be kept apart",
      "use a kernel with CONFIG_SECCOMP_FILTER, or run the command line instead of the server"));
}

}  // namespace eyebox::service
