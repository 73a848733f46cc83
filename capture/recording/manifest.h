// manifest.log: which captures are published, and checksums of all that is not under its own.
#ifndef EYEBOX_CAPTURE_RECORDING_MANIFEST_H_
#define EYEBOX_CAPTURE_RECORDING_MANIFEST_H_

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/image.h"
#include "capture/base/unix_file.h"
#include "capture/recording/side_rows.h"

namespace eyebox::capture {

struct ManifestEntry {
  int number = 0;
  CaptureSpec spec;
  ImageSize frame_size;
  int frame_count = 0;
  int row_count = 0;  // of /frames; more than frame_count where the capture stopped early
  bool packed = false;
  std::string suspect;  // why it must not be used; empty where it may
  uint64_t file_bytes = 0;
  uint64_t frames_offset_bytes = 0;  // 0 in a packed file
  uint64_t records_offset_bytes = 0;
  SideRows side = {};
  uint64_t digest_xxh3 = 0;  // of the file without /frames; of a packed file, of the whole

  uint64_t FrameBytes() const { return frame_size.PixelCount() * sizeof(uint16_t); }
  // Of /frames in the file; nothing where chunks are scattered over it.
  uint64_t FramesBytes() const {
    return packed ? 0 : FrameBytes() * static_cast<uint64_t>(row_count);
  }
  uint64_t FrameOffset(uint64_t row) const { return frames_offset_bytes + row * FrameBytes(); }
  uint64_t RecordOffset(uint64_t row) const;
};

// Published captures `first` to `last` that must not be used.
struct SuspectCaptures {
  int first = 0;
  int last = 0;
  std::string reason;  // not empty
};

// A capture file that was about to take its first frame.
struct BegunCapture {
  ManifestEntry entry;          // frame_count is row_count, digest_xxh3 0
  uint64_t structure_xxh3 = 0;  // of the file without /frames, /frame_records and side rows
};

struct Manifest {
  uint64_t header_bytes = 0;
  uint64_t header_xxh3 = 0;
  std::vector<ManifestEntry> entries;
  std::optional<BegunCapture> begun;  // the one under way, or given up
};

// What digest_xxh3 and structure_xxh3 must be, of a capture's file. Errors: the errno of the disk.
absl::StatusOr<uint64_t> DigestOf(const UnixFile& file, const ManifestEntry& entry);
absl::StatusOr<uint64_t> StructureOf(const UnixFile& file, const ManifestEntry& entry);

// As many whole records as stand at the beginning of manifest.log.
struct ManifestScan {
  Manifest manifest;
  std::string bytes;         // of the file
  uint64_t whole_bytes = 0;  // that those records take
  absl::Status rest;         // what is wrong with the bytes behind them; OK where there are none
};

// Appends; every record is durable when its call returns OK. Locks the file against a second
// writer.
class ManifestLog {
 public:
  // Creates the file and its first record. `header_text` is the content of recording.textproto.
  static absl::StatusOr<ManifestLog> Create(const std::filesystem::path& file,
                                            std::string_view header_text);
  // To go on behind the last whole record; `scan` tells what stands before it.
  // Errors: those of ScanManifest; FailedPrecondition (locked: it is being recorded to).
  static absl::StatusOr<ManifestLog> Open(const std::filesystem::path& file, ManifestScan& scan);

  // Errors: the errno of the disk; after one, nothing more may be appended.
  absl::Status Append(const ManifestEntry& entry);
  absl::Status Append(const BegunCapture& begun);
  absl::Status Append(const SuspectCaptures& suspects);
  // Removes what stands behind the last whole record.
  absl::Status CutRest();

 private:
  explicit ManifestLog(UnixFile file) : file_(std::move(file)) {}
  absl::Status Lock();
  absl::Status AppendRecord(uint32_t type, const std::string& payload);

  UnixFile file_;
  uint64_t end_ = 0;
};

// Errors: NotFound, the errno of the disk, InvalidArgument (written by a newer version).
absl::StatusOr<ManifestScan> ScanManifest(const std::filesystem::path& file);

// Whether a whole record begins anywhere in `bytes`.
bool HoldsWholeRecord(std::string_view bytes);

// A record that a living writer is just appending is not there yet.
// Errors: those of ScanManifest; DataLoss (a record that is torn or damaged, numbers with a gap).
// Each names file and byte.
absl::StatusOr<Manifest> ReadManifest(const std::filesystem::path& file);

// Whether a writer has the recording open.
absl::StatusOr<bool> IsBeingWritten(const std::filesystem::path& manifest);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_MANIFEST_H_
