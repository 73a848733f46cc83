// A file descriptor that closes itself, with the system calls that durable files need.
#ifndef EYEBOX_CAPTURE_BASE_UNIX_FILE_H_
#define EYEBOX_CAPTURE_BASE_UNIX_FILE_H_

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox {

// Errors of all functions: the errno of the file system, naming the file. Interrupted and short
// transfers are carried on with.
class UnixFile {
 public:
  static absl::StatusOr<UnixFile> OpenToRead(const std::filesystem::path& file);
  static absl::StatusOr<UnixFile> OpenToWrite(const std::filesystem::path& file);
  // Empty, whatever was there before.
  static absl::StatusOr<UnixFile> Create(const std::filesystem::path& file);

  UnixFile(UnixFile&& other) noexcept
      : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}
  UnixFile& operator=(UnixFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~UnixFile();

  const std::filesystem::path& path() const { return path_; }

  absl::StatusOr<uint64_t> Size() const;
  // Also DataLoss: the file ends before `offset + size`.
  absl::Status ReadAt(uint64_t offset, void* data, size_t size) const;
  absl::Status WriteAt(uint64_t offset, const void* data, size_t size);
  // A hint to write these bytes out meanwhile, so that a later sync waits less; promises nothing.
  void StartWriting(uint64_t offset, uint64_t size);
  // posix_fallocate: later writes below `size` do not fail for want of space.
  absl::Status Reserve(uint64_t size);
  // A failed sync must not be tried again: the kernel may have dropped the pages.
  absl::Status Sync();
  absl::Status SyncData();  // fdatasync
  absl::Status Truncate(uint64_t size);

  enum class Lock { kShared, kExclusive };
  // flock() until the file is closed, by kill -9 too. False: another open file holds it.
  absl::StatusOr<bool> TryLock(Lock lock);

 private:
  UnixFile(std::filesystem::path path, int descriptor)
      : path_(std::move(path)), descriptor_(descriptor) {}

  std::filesystem::path path_;
  int descriptor_ = -1;
};

// Makes a rename or a new file in `folder` durable.
absl::Status SyncFolder(const std::filesystem::path& folder);

// rename(), then SyncFolder() of the folder of `to`.
absl::Status RenameDurably(const std::filesystem::path& from, const std::filesystem::path& to);

// create_directories() as a status.
absl::Status CreateFolders(const std::filesystem::path& folder);

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_UNIX_FILE_H_
