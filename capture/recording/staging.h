// A folder that appears whole under its name or not at all.
#ifndef EYEBOX_CAPTURE_RECORDING_STAGING_H_
#define EYEBOX_CAPTURE_RECORDING_STAGING_H_

#include <filesystem>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::capture {

// Work in path(), then Commit(); without it the folder is removed with the object.
class StagedFolder {
 public:
  // Beside `target`, so that the rename stays on one disk.
  // Errors: AlreadyExists (`target` exists and is not an empty folder), the errno of the disk.
  static absl::StatusOr<StagedFolder> Begin(const std::filesystem::path& target);
  StagedFolder(StagedFolder&& other) noexcept
      : target_(std::move(other.target_)), path_(std::exchange(other.path_, {})) {}
  StagedFolder& operator=(StagedFolder&&) = delete;
  ~StagedFolder();

  const std::filesystem::path& path() const { return path_; }
  absl::Status Commit();

 private:
  StagedFolder(std::filesystem::path target, std::filesystem::path path)
      : target_(std::move(target)), path_(std::move(path)) {}

  std::filesystem::path target_;
  std::filesystem::path path_;  // empty once committed
};

// Errors: AlreadyExists.
absl::Status CheckVacant(const std::filesystem::path& folder);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_STAGING_H_
