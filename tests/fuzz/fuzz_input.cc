#include "tests/fuzz/fuzz_input.h"

#include <sys/mman.h>
#include <unistd.h>

namespace eyebox::fuzz {
namespace {

struct Folder {
  Folder() {
    std::string form = (std::filesystem::temp_directory_path() / "eyebox-fuzz-XXXXXX").string();
    path = mkdtemp(form.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

}  // namespace

std::filesystem::path MemoryFile(std::string_view content) {
  static const int file = memfd_create("fuzz", MFD_CLOEXEC);
  FUZZ_CHECK(file >= 0 && ftruncate(file, 0) == 0);
  FUZZ_CHECK(pwrite(file, content.data(), content.size(), 0) ==
             static_cast<ssize_t>(content.size()));
  return "/proc/self/fd/" + std::to_string(file);
}

const std::filesystem::path& ScratchFolder() {
  static const Folder folder;
  return folder.path;
}

}  // namespace eyebox::fuzz
