#include "service/server/secret_file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

absl::StatusOr<std::string> ReadSecretFile(const std::filesystem::path& file, size_t limit_bytes) {
  const OwnedFd fd(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (fd.get() < 0) return SystemFailed(file.string(), errno, "give a file that may be read");
  struct stat status = {};
  if (fstat(fd.get(), &status) != 0) {
    return SystemFailed(file.string(), errno, "give a file that may be read");
  }
  if (!S_ISREG(status.st_mode)) {
    return BadInput(file.string(), "is no file", "give a file with the secret");
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Rejected(file.string(), "holds a secret and is open to others than its owner",
                    "chmod 600 it, and replace the secret if others may have read it");
  }
  auto content = ReadWholeFile(fd.Path(), limit_bytes);
  if (content.ok()) return content;
  return BadInput(file.string(),
                  "cannot be read, or holds more than " + std::to_string(limit_bytes) + " bytes",
                  "give the file of the secret alone");
}

}  // namespace eyebox::service
