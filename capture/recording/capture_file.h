// The HDF5 side of a capture file: the only place that calls libhdf5. It is closed again when a
// function returns, and one call runs at a time in the process (libhdf5 is not thread-safe).
#ifndef EYEBOX_CAPTURE_RECORDING_CAPTURE_FILE_H_
#define EYEBOX_CAPTURE_RECORDING_CAPTURE_FILE_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "capture/recording/side_rows.h"

namespace eyebox::capture {

struct CaptureFileShape {
  ImageSize frame_size;
  int frame_count = 0;
  SideRows side = {};  // its capacities
};

// Scalar strings, written as /meta/NAME.
using MetaStrings = std::vector<std::pair<std::string, std::string>>;

struct CaptureFileLayout {
  uint64_t file_bytes = 0;
  uint64_t frames_offset_bytes = 0;  // 0 in a packed file
  uint64_t records_offset_bytes = 0;
  SideRows side = {};  // with its offsets
};

// /frames uint16 [N, height, width], /frame_records [N] and the side rows, contiguous, allocated,
// not filled: the caller writes all of them at their offsets. Errors: Internal (libhdf5 refused,
// with its reason).
absl::StatusOr<CaptureFileLayout> CreateCaptureFile(const std::filesystem::path& file,
                                                    const CaptureFileShape& shape,
                                                    const MetaStrings& meta);

// The same with /frames in one chunk a frame, shuffled and deflated; libhdf5 keeps the file open
// until Finish(). Records and side rows are the caller's to write afterwards.
class PackedFileWriter {
 public:
  virtual ~PackedFileWriter() = default;
  // Frames in order. Errors: Internal (libhdf5 refused).
  virtual absl::Status Append(std::span<const uint16_t> pixels_dn) = 0;
  virtual absl::StatusOr<CaptureFileLayout> Finish() = 0;

  static absl::StatusOr<std::unique_ptr<PackedFileWriter>> Create(const std::filesystem::path& file,
                                                                  const CaptureFileShape& shape,
                                                                  const MetaStrings& meta);
};

// Reads frames of a packed file whose bytes were verified before.
class PackedFrames {
 public:
  virtual ~PackedFrames() = default;
  // Errors: DataLoss (libhdf5 cannot decode it).
  virtual absl::Status Read(int frame, std::span<uint16_t> pixels_dn) = 0;

  // Errors: DataLoss (not an HDF5 file, no /frames of this shape).
  static absl::StatusOr<std::unique_ptr<PackedFrames>> Open(const std::filesystem::path& file,
                                                            const CaptureFileShape& shape);
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_CAPTURE_FILE_H_
