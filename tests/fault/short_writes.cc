// Preloaded: of every write to a file at most EYEBOX_SHORT_WRITE_BYTES are taken, and every other
// call is interrupted before it took any.
#include <errno.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace {

size_t Limit(size_t size) {
  static const char* const limit = std::getenv("EYEBOX_SHORT_WRITE_BYTES");
  return limit ? std::min<size_t>(size, std::strtoul(limit, nullptr, 10)) : size;
}

bool Interrupted() {
  static bool now = false;
  now = !now;
  if (now) errno = EINTR;
  return now;
}

ssize_t ShortPwrite(int file, const void* data, size_t size, off_t offset) {
  if (Interrupted()) return -1;
  return ::syscall(SYS_pwrite64, file, data, Limit(size), offset);
}

}  // namespace

extern "C" ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  return ShortPwrite(file, data, size, offset);
}

extern "C" ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  return ShortPwrite(file, data, size, offset);
}
