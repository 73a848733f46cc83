// XXH3-64: the checksum of frames, records and files.
#ifndef EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_
#define EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "absl/status/statusor.h"
#include "capture/base/unix_file.h"

namespace eyebox::capture {

uint64_t Checksum(const void* data, size_t size);
inline uint64_t Checksum(std::string_view bytes) { return Checksum(bytes.data(), bytes.size()); }

struct ByteRange {
  uint64_t offset = 0;
  uint64_t size = 0;
};

// Of all bytes of `file` except those in `skipped`, which stand in order; read a MiB at a time.
// Errors: the errno of the disk.
absl::StatusOr<uint64_t> ChecksumOutside(const UnixFile& file, std::span<const ByteRange> skipped);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_
