// Opens what a client named, beneath a folder and through no symbolic link.
#ifndef EYEBOX_SERVICE_SERVER_STORE_BENEATH_H_
#define EYEBOX_SERVICE_SERVER_STORE_BENEATH_H_

#include <filesystem>
#include <string>
#include <utility>

#include "absl/status/statusor.h"

namespace eyebox::service {

// A file descriptor, closed at the end of its life.
class OwnedFd {
 public:
  explicit OwnedFd(int fd = -1) : fd_(fd) {}
  OwnedFd(OwnedFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  OwnedFd& operator=(OwnedFd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~OwnedFd();
  int get() const { return fd_; }
  // Leads to what the descriptor holds open, whatever is renamed in the meantime.
  std::filesystem::path Path() const;

 private:
  int fd_;
};

// The folder that clients' names are resolved in; pinned, so that it may be renamed.
class RootFolder {
 public:
  // Errors: NotFound, InvalidArgument (not a folder), PermissionDenied.
  static absl::StatusOr<RootFolder> Open(const std::filesystem::path& folder);

  // `relative` is as CheckName returned it; messages name it, never a path of the host.
  // Errors: NotFound; PermissionDenied if it leads outside or through a symbolic link.
  absl::StatusOr<OwnedFd> OpenFile(const std::string& relative) const;
  // Also refuses a folder with a symbolic link or a special file anywhere in it.
  absl::StatusOr<OwnedFd> OpenFolder(const std::string& relative) const;

  // As OwnedFd::Path().
  std::filesystem::path Path() const { return fd_.Path(); }

 private:
  explicit RootFolder(OwnedFd fd) : fd_(std::move(fd)) {}
  absl::StatusOr<OwnedFd> OpenBeneath(const std::string& relative, int flags) const;

  OwnedFd fd_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_BENEATH_H_
