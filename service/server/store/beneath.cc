#include "service/server/store/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <system_error>

#include "capture/base/status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

constexpr char kRemedy[] = "give a path below the folder that is served";

absl::Status Refused(const std::string& relative, const std::string& what) {
  return absl::PermissionDeniedError(Complaint(relative, what, kRemedy));
}

// A link inside a recording would lead the reader out of the folder.
absl::Status CheckPlainTree(const std::filesystem::path& folder, const std::string& relative) {
  std::error_code error;
  std::filesystem::recursive_directory_iterator entry(folder / ".", error);
  for (; !error && entry != std::filesystem::end(entry); entry.increment(error)) {
    const auto type = entry->symlink_status(error).type();
    if (type != std::filesystem::file_type::regular &&
        type != std::filesystem::file_type::directory) {
      return Refused(relative, "holds " + Quoted(entry->path().filename().string()) +
                                   ", which is neither a file nor a folder");
    }
  }
  if (error) return SystemFailed(relative, error.value(), "make it readable for the server");
  return absl::OkStatus();
}

}  // namespace

OwnedFd::~OwnedFd() {
  if (fd_ >= 0) close(fd_);
}

std::filesystem::path OwnedFd::Path() const { return "/proc/self/fd/" + std::to_string(fd_); }

absl::StatusOr<RootFolder> RootFolder::Open(const std::filesystem::path& folder) {
  OwnedFd fd(open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() < 0) return SystemFailed(folder.string(), errno, "give a folder that exists");
  return RootFolder(std::move(fd));
}

absl::StatusOr<OwnedFd> RootFolder::OpenBeneath(const std::string& relative, int flags) const {
  struct open_how how = {};
  how.flags = static_cast<unsigned>(flags | O_CLOEXEC | O_NONBLOCK);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  OwnedFd fd(
      static_cast<int>(syscall(SYS_openat2, fd_.get(), relative.c_str(), &how, sizeof(how))));
  if (fd.get() >= 0) return fd;
  switch (errno) {
    case ENOENT:
    case ENOTDIR:
      return Missing(relative, "does not exist in the folder that is served", kRemedy);
    case ELOOP:
      return Refused(relative, "leads through a symbolic link");
    case EXDEV:
      return Refused(relative, "leads out of the folder that is served");
    case ENOSYS:
      return absl::UnimplementedError(
          Complaint(relative, "cannot be opened safely: the kernel has no openat2",
                    "use Linux 5.6 or newer"));
    default:
      return SystemFailed(relative, errno, "make it readable for the server");
  }
}

absl::StatusOr<OwnedFd> RootFolder::OpenFile(const std::string& relative) const {
  return OpenBeneath(relative, O_RDONLY);
}

absl::StatusOr<OwnedFd> RootFolder::OpenFolder(const std::string& relative) const {
  EYEBOX_ASSIGN_OR_RETURN(OwnedFd folder, OpenBeneath(relative, O_RDONLY | O_DIRECTORY));
  EYEBOX_RETURN_IF_ERROR(CheckPlainTree(folder.Path(), relative));
  return folder;
}

}  // namespace eyebox::service
