// Reads a recording frame by frame; memory does not grow with its length.
#ifndef EYEBOX_CAPTURE_RECORDING_READER_H_
#define EYEBOX_CAPTURE_RECORDING_READER_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock_triple.h"
#include "capture/base/frame.h"
#include "capture/base/sample_block.h"
#include "capture/recording/header.h"

namespace eyebox::capture {

// One published capture file.
struct CaptureEntry {
  int number = 0;  // 1, 2, ... as in captures/000001.h5
  CaptureSpec spec;
  ImageSize frame_size;
  int frame_count = 0;  // whole frames; fewer than spec.repeats where the capture stopped early
  bool packed = false;  // compressed afterwards (`pack`)
  std::filesystem::path file;
  // Why it must not be used (the headset slept meanwhile); empty where it may.
  std::string suspect = {};
  int64_t sample_count = 0;  // of the photodiode
  int64_t samples_lost = 0;  // samples that came and found no room
};

// Sees the captures that were published when it was opened, also while more are recorded.
// Not thread-safe (libhdf5 is not); several readers may read one recording in turn.
class RecordingReader {
 public:
  // Reads header, manifest and the capture list; verifies the manifest's checksums.
  // Errors: NotFound (no recording there), InvalidArgument (malformed header), DataLoss
  // (manifest or capture file damaged or missing); each names the file and what to do.
  static absl::StatusOr<std::unique_ptr<RecordingReader>> Open(
      const std::filesystem::path& recording);
  virtual ~RecordingReader() = default;

  virtual const RecordingHeader& Header() const = 0;
  virtual std::span<const CaptureEntry> Captures() const = 0;

  using FrameVisitor = std::function<absl::Status(const Frame&)>;
  // Calls `visit` for every frame of the capture in order, each verified against its checksum
  // before it is shown. One buffer is reused: the pixels are valid during the call only.
  // Stops at the first error, the visitor's or DataLoss (file and frame named).
  virtual absl::Status VisitFrames(const CaptureEntry& capture, const FrameVisitor& visit) = 0;

  using SampleVisitor = std::function<absl::Status(const SampleBlock&)>;
  // The same for the photodiode's samples: blocks as they were appended (one that found room in
  // part is shorter). sequence counts from the start of the photodiode, which is that of the
  // capture. Nothing is shown where there was no photodiode.
  virtual absl::Status VisitSamples(const CaptureEntry& capture, const SampleVisitor& visit) = 0;
  // In the order in which they were taken; empty where there are none. Errors: DataLoss.
  virtual absl::StatusOr<std::vector<ClockTriple>> ClockTriples(const CaptureEntry& capture) = 0;
};

// Reads every byte of every capture and compares it with its checksums.
// Returns the number of frames verified, or the first DataLoss.
struct VerifyReport {
  int captures = 0;
  int64_t frames = 0;
  int64_t samples = 0;  // of photodiodes
  int64_t bytes = 0;
};
absl::StatusOr<VerifyReport> VerifyRecording(const std::filesystem::path& recording);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_READER_H_
