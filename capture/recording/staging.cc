#include "capture/recording/staging.h"

#include <unistd.h>

#include <string>
#include <system_error>

#include "capture/base/status.h"
#include "capture/base/unix_file.h"

namespace eyebox::capture {

absl::Status CheckVacant(const std::filesystem::path& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) return absl::OkStatus();
  if (std::filesystem::is_directory(folder, error) && std::filesystem::is_empty(folder, error)) {
    return absl::OkStatus();
  }
  return absl::AlreadyExistsError(Complaint(folder.string(), "exists and is not an empty folder",
                                            "name a folder that does not exist yet"));
}

absl::StatusOr<StagedFolder> StagedFolder::Begin(const std::filesystem::path& target) {
  std::filesystem::path clean = target.lexically_normal();
  if (!clean.has_filename()) clean = clean.parent_path();  // "rec/" is "rec"
  EYEBOX_RETURN_IF_ERROR(CheckVacant(clean));
  const std::string name =
      "." + clean.filename().string() + "." + std::to_string(::getpid()) + ".unfinished";
  std::filesystem::path staged = clean.parent_path() / name;
  std::error_code ignored;
  std::filesystem::remove_all(staged, ignored);  // of a process that had this number before
  EYEBOX_RETURN_IF_ERROR(CreateFolders(staged));
  return StagedFolder(std::move(clean), std::move(staged));
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

absl::Status StagedFolder::Commit() {
  EYEBOX_RETURN_IF_ERROR(RenameDurably(path_, target_));
  path_.clear();
  return absl::OkStatus();
}

}  // namespace eyebox::capture
