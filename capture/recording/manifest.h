// manifest.log: which captures are published, and checksums of all that is not under its own.
#ifndef EYEBOX_CAPTURE_RECORDING_MANIFEST_H_
#define EYEBOX_CAPTURE_RECORDING_MANIFEST_H_

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/image.h"
#include "capture/base/unix_file.h"

namespace eyebox::capture {

struct ManifestEntry {
  int number = 0;
  CaptureSpec spec;
  ImageSize frame_size;
  int frame_count = 0;
  bool packed = false;
  uint64_t file_bytes = 0;
  uint64_t frames_offset_bytes = 0;  // 0 in a packed file
  uint64_t records_offset_bytes = 0;
  uint64_t digest_xxh3 = 0;  // of the file without /frames; of a packed file, of the whole

  uint64_t FrameBytes() const { return frame_size.PixelCount() * sizeof(uint16_t); }
  // Of /frames in the file; nothing where chunks are scattered over it.
  uint64_t FramesBytes() const {
    return packed ? 0 : FrameBytes() * static_cast<uint64_t>(frame_count);
  }
};

// Appends; every record is durable when its call returns OK.
class ManifestLog {
 public:
  // Creates the file and its first record. `header_text` is the content of recording.textproto.
  static absl::StatusOr<ManifestLog> Create(const std::filesystem::path& file,
                                            std::string_view header_text);
  // Errors: the errno of the disk; after one, nothing more may be appended.
  absl::Status Append(const ManifestEntry& entry);

 private:
  explicit ManifestLog(UnixFile file) : file_(std::move(file)) {}
  absl::Status AppendRecord(uint32_t type, const std::string& payload);

  UnixFile file_;
  uint64_t end_ = 0;
};

struct Manifest {
  uint64_t header_bytes = 0;
  uint64_t header_xxh3 = 0;
  std::vector<ManifestEntry> entries;
};

// Errors: NotFound; DataLoss (a record that is torn or damaged, numbers with a gap);
// InvalidArgument (written by a newer version). Each names file and byte.
absl::StatusOr<Manifest> ReadManifest(const std::filesystem::path& file);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_MANIFEST_H_
