// Writes a recording that survives kill -9: what was acknowledged is on stable storage, bit-exact,
// in files that any HDF5 reader opens. The form is written down in proto/README.md.
#ifndef EYEBOX_CAPTURE_RECORDING_WRITER_H_
#define EYEBOX_CAPTURE_RECORDING_WRITER_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/base/clock_triple.h"
#include "capture/base/frame.h"
#include "capture/base/sample_block.h"
#include "capture/recording/header.h"

namespace eyebox::capture {

// Room for what accompanies the frames of a capture. It is taken ahead, as that of the frames is.
struct SideRoom {
  int64_t samples = 0;    // of the photodiode: its rate times the time expected, with a margin
  int clock_triples = 0;  // one when it begins and one when it ends, say
};

// One capture file while it is being filled. Destroyed before Publish(), it leaves its .partial.
class CaptureWriter {
 public:
  virtual ~CaptureWriter() = default;
  // Writes pixels and record at their place. Not yet durable.
  // Errors: InvalidArgument (frame of another size, more frames than announced),
  // FailedPrecondition (the frame is not complete: it is not data), the errno of the disk.
  virtual absl::Status Append(const Frame& frame) = 0;
  // Writes samples of the photodiode at their place, with the room of BeginCapture(). What finds
  // none is counted, see samples_lost(). Not yet durable.
  // Errors: InvalidArgument (an empty block, device times of another number), the errno of the
  // disk.
  virtual absl::Status AppendSamples(const SampleBlock& block) = 0;
  // Errors: ResourceExhausted (more than there is room for), the errno of the disk.
  virtual absl::Status AppendClockTriple(const ClockTriple& triple) = 0;
  // Samples that found no room since the capture began.
  virtual int64_t samples_lost() const = 0;
  // One fdatasync: everything appended so far is on stable storage when this returns OK.
  // After an error the file is abandoned: a failed fsync is never retried.
  virtual absl::Status Acknowledge() = 0;
  // fsync, rename to its final name, fsync of the folder, entry in the manifest.
  // Errors: FailedPrecondition (fewer frames than announced or some unacknowledged).
  virtual absl::Status Publish() = 0;
  // The same with fewer frames than announced; the file keeps its shape, the rows behind stay
  // empty. Errors: FailedPrecondition (no frame, or some unacknowledged).
  virtual absl::Status PublishEarly() = 0;
};

// Not thread-safe. One capture is open at a time, and one writer per recording: manifest.log is
// locked. Readers may open the recording meanwhile and see what is published.
class RecordingWriter {
 public:
  // Creates the folder (which must not exist or be empty) and its header, and opens the manifest.
  // `clock` must outlive the writer. Errors: AlreadyExists, the errno of the file system.
  static absl::StatusOr<std::unique_ptr<RecordingWriter>> Create(
      const std::filesystem::path& recording, const RecordingHeader& header, const Clock* clock);
  // Goes on with a recording that was interrupted; RemainingCaptures() says what is left to take.
  // Errors: those of RecordingReader::Open; FailedPrecondition (something else records to it;
  // a capture was under way when it was interrupted: RecoverRecording comes first).
  static absl::StatusOr<std::unique_ptr<RecordingWriter>> Resume(
      const std::filesystem::path& recording);
  virtual ~RecordingWriter() = default;

  // Reserves the space of `spec.repeats` frames, and `room`, before the first one.
  // Errors: ResourceExhausted (disk full; says how much is needed and free), InvalidArgument.
  virtual absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec& spec,
                                                                      ImageSize frame_size,
                                                                      const SideRoom& room) = 0;
  // Frames alone.
  absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec& spec,
                                                              ImageSize frame_size) {
    return BeginCapture(spec, frame_size, {});
  }

  // Captures published since number `first` (1, 2, ... as in their file names) must not be used,
  // for `reason`; RemainingCaptures() names them again. Durable when this returns OK.
  // Errors: InvalidArgument (none of that number is published, no reason), FailedPrecondition (a
  // capture is open), the errno of the disk.
  virtual absl::Status SuspectSince(int first, const std::string& reason) = 0;
  // Captures published so far, those of earlier sessions and suspect ones included.
  virtual int PublishedCount() const = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_WRITER_H_
