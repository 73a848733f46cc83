#include "capture/base/file.h"

#include <unistd.h>

#include "capture/base/status.h"
#include "capture/base/unix_file.h"

namespace eyebox {
namespace {

absl::Status WriteDurably(const std::filesystem::path& file, std::string_view content) {
  EYEBOX_ASSIGN_OR_RETURN(UnixFile written, UnixFile::Create(file));
  EYEBOX_RETURN_IF_ERROR(written.WriteAt(0, content.data(), content.size()));
  return written.Sync();
}

}  // namespace

absl::StatusOr<std::string> ReadWholeFile(const std::filesystem::path& file, size_t limit_bytes) {
  EYEBOX_ASSIGN_OR_RETURN(const UnixFile opened, UnixFile::OpenToRead(file));
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t size, opened.Size());
  if (size > limit_bytes) {
    return BadInput(file.string(),
                    "holds " + std::to_string(size) + " bytes, more than the " +
                        std::to_string(limit_bytes) + " that such a file may have",
                    "check that it is the right file");
  }
  std::string content(size, '\0');
  EYEBOX_RETURN_IF_ERROR(opened.ReadAt(0, content.data(), content.size()));
  return content;
}

absl::Status WriteFileAtomically(const std::filesystem::path& file, std::string_view content) {
  if (file.has_parent_path()) EYEBOX_RETURN_IF_ERROR(CreateFolders(file.parent_path()));
  std::filesystem::path temporary = file;
  temporary += "." + std::to_string(::getpid()) + ".tmp";
  absl::Status status = WriteDurably(temporary, content);
  if (status.ok()) status = RenameDurably(temporary, file);
  if (!status.ok()) ::unlink(temporary.c_str());
  return status;
}

}  // namespace eyebox
