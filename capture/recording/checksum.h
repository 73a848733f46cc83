// XXH3-64: the checksum of frames, records and files.
#ifndef EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_
#define EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "absl/status/statusor.h"
#include "capture/base/unix_file.h"

namespace eyebox::capture {

uint64_t Checksum(const void* data, size_t size);
inline uint64_t Checksum(std::string_view bytes) { return Checksum(bytes.data(), bytes.size()); }

// Of all bytes of `file` except those in [skip_offset, skip_offset + skip_size), read a MiB at a
// time. Errors: the errno of the disk.
absl::StatusOr<uint64_t> ChecksumOutside(const UnixFile& file, uint64_t skip_offset,
                                         uint64_t skip_size);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_CHECKSUM_H_
