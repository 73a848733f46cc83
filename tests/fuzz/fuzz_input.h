// What the targets share. A target is LLVMFuzzerTestOneInput in a file of its own: it must come
// back from any bytes without a crash, and keeps what it was promised (FUZZ_CHECK).
#ifndef EYEBOX_TESTS_FUZZ_FUZZ_INPUT_H_
#define EYEBOX_TESTS_FUZZ_FUZZ_INPUT_H_

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

// Every target; declared here because libFuzzer's header is no part of Debian's clang package.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

#define FUZZ_CHECK(condition)                                                                     \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      std::fprintf(stderr, "%s:%d: promised and not kept: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                               \
    }                                                                                             \
  } while (false)

namespace eyebox::fuzz {

inline std::string_view AsText(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// The one file of this process, in memory, with `content`.
std::filesystem::path MemoryFile(std::string_view content);

// A folder that goes away when the process ends.
const std::filesystem::path& ScratchFolder();

}  // namespace eyebox::fuzz

#endif  // EYEBOX_TESTS_FUZZ_FUZZ_INPUT_H_
