// Compression after the measurement: to archive a recording, or to carry it in a repository.
#ifndef EYEBOX_CAPTURE_RECORDING_PACK_H_
#define EYEBOX_CAPTURE_RECORDING_PACK_H_

#include <cstdint>
#include <filesystem>
#include <functional>

#include "absl/status/statusor.h"

namespace eyebox::capture {

struct PackReport {
  int captures = 0;
  int64_t frames = 0;
  int64_t bytes_before = 0;  // of the capture files
  int64_t bytes_after = 0;
};

// Called after every capture.
using PackProgress = std::function<void(int captures_done, int captures_total)>;

// Copies `recording` to `packed` with every frame a chunk of its own, shuffled and deflated;
// header, frames, records, samples and clock triples are the same bit for bit; rows without a frame
// are left out, and those behind them count on. Every frame is verified while it is read and again
// after it was written. `packed` appears whole or not at all; results/ is not copied. Errors: those
// of RecordingReader; AlreadyExists, Internal (libhdf5), the errno of the disk.
absl::StatusOr<PackReport> PackRecording(const std::filesystem::path& recording,
                                         const std::filesystem::path& packed,
                                         const PackProgress& progress = nullptr);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_PACK_H_
