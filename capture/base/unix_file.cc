#include "capture/base/unix_file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <system_error>

#include "capture/base/status.h"

namespace eyebox {
namespace {

std::string RemedyFor(int error_number) {
  switch (error_number) {
    case ENOENT:
      return "check the path";
    case EACCES:
    case EPERM:
    case EROFS:
      return "check who may read and write there";
    case ENOSPC:
    case EDQUOT:
      return "free space or use another disk";
    case EIO:
      return "the disk may be failing: copy what can be read and replace it";
    default:
      return "check the path and the disk";
  }
}

absl::Status Failed(const std::filesystem::path& file, int error_number) {
  return SystemFailed(file.string(), error_number, RemedyFor(error_number));
}

// The descriptor, or the negated errno.
int OpenDescriptor(const std::filesystem::path& file, int flags) {
  int descriptor = -1;
  do {
    descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
  } while (descriptor < 0 && errno == EINTR);
  return descriptor < 0 ? -errno : descriptor;
}

}  // namespace

absl::StatusOr<UnixFile> UnixFile::OpenToRead(const std::filesystem::path& file) {
  const int descriptor = OpenDescriptor(file, O_RDONLY);
  if (descriptor < 0) return Failed(file, -descriptor);
  UnixFile opened(file, descriptor);
  struct stat state {};
  if (::fstat(descriptor, &state) != 0) return Failed(file, errno);
  if (S_ISDIR(state.st_mode)) return BadInput(file.string(), "is a folder", "name a file");
  return opened;
}

absl::StatusOr<UnixFile> UnixFile::OpenToWrite(const std::filesystem::path& file) {
  const int descriptor = OpenDescriptor(file, O_RDWR);
  if (descriptor < 0) return Failed(file, -descriptor);
  return UnixFile(file, descriptor);
}

absl::StatusOr<UnixFile> UnixFile::Create(const std::filesystem::path& file) {
  const int descriptor = OpenDescriptor(file, O_RDWR | O_CREAT | O_TRUNC);
  if (descriptor < 0) return Failed(file, -descriptor);
  return UnixFile(file, descriptor);
}

UnixFile::~UnixFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

absl::StatusOr<uint64_t> UnixFile::Size() const {
  struct stat state {};
  if (::fstat(descriptor_, &state) != 0) return Failed(path_, errno);
  return static_cast<uint64_t>(state.st_size);
}

absl::Status UnixFile::ReadAt(uint64_t offset, void* data, size_t size) const {
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::pread(descriptor_, to, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Failed(path_, errno);
    if (got == 0) {
      return Corrupt(path_.string(), "ends at byte " + std::to_string(offset) + ", too early",
                     "restore it from a copy");
    }
    to += got;
    offset += static_cast<uint64_t>(got);
    size -= static_cast<size_t>(got);
  }
  return absl::OkStatus();
}

absl::Status UnixFile::WriteAt(uint64_t offset, const void* data, size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t put = ::pwrite(descriptor_, from, size, static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) return Failed(path_, errno);
    if (put == 0) return Failed(path_, EIO);  // or this would go on for ever
    from += put;
    offset += static_cast<uint64_t>(put);
    size -= static_cast<size_t>(put);
  }
  return absl::OkStatus();
}

void UnixFile::StartWriting(uint64_t offset, uint64_t size) {
  // What goes wrong on the way is reported by the next sync, and only there.
  static_cast<void>(::sync_file_range(descriptor_, static_cast<off64_t>(offset),
                                      static_cast<off64_t>(size), SYNC_FILE_RANGE_WRITE));
}

absl::Status UnixFile::Reserve(uint64_t size) {
  int error_number = 0;
  do {
    error_number = ::posix_fallocate(descriptor_, 0, static_cast<off_t>(size));
  } while (error_number == EINTR);
  return error_number == 0 ? absl::OkStatus() : Failed(path_, error_number);
}

absl::Status UnixFile::Sync() {
  return ::fsync(descriptor_) == 0 ? absl::OkStatus() : Failed(path_, errno);
}

absl::Status UnixFile::SyncData() {
  return ::fdatasync(descriptor_) == 0 ? absl::OkStatus() : Failed(path_, errno);
}

absl::Status UnixFile::Truncate(uint64_t size) {
  return ::ftruncate(descriptor_, static_cast<off_t>(size)) == 0 ? absl::OkStatus()
                                                                 : Failed(path_, errno);
}

absl::StatusOr<bool> UnixFile::TryLock(Lock lock) {
  const int operation = lock == Lock::kShared ? LOCK_SH : LOCK_EX;
  if (::flock(descriptor_, operation | LOCK_NB) == 0) return true;
  if (errno == EWOULDBLOCK) return false;
  return Failed(path_, errno);
}

absl::Status SyncFolder(const std::filesystem::path& folder) {
  const std::filesystem::path opened = folder.empty() ? std::filesystem::path(".") : folder;
  const int descriptor = OpenDescriptor(opened, O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) return Failed(opened, -descriptor);
  const absl::Status status = ::fsync(descriptor) == 0 ? absl::OkStatus() : Failed(opened, errno);
  ::close(descriptor);
  return status;
}

absl::Status RenameDurably(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) return Failed(to, errno);
  return SyncFolder(to.parent_path());
}

absl::Status CreateFolders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return error ? Failed(folder, error.value()) : absl::OkStatus();
}

}  // namespace eyebox
