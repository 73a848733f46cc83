// Carries out a plan: every capture ends up complete on disk, or the run fails and says where.
#ifndef EYEBOX_CAPTURE_RUN_H_
#define EYEBOX_CAPTURE_RUN_H_

#include <chrono>
#include <cstdint>
#include <functional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/clock.h"
#include "capture/camera/rig.h"
#include "capture/recording/header.h"
#include "capture/recording/writer.h"

namespace eyebox::capture {

struct RunProgress {
  int captures_done = 0;
  int captures_total = 0;
  const CaptureSpec& next;  // the capture that begins now
};

struct RunOptions {
  std::function<void(const RunProgress&)> progress = nullptr;  // before every capture
  std::function<bool()> cancelled = nullptr;                   // asked before every frame
  int attempts = 3;  // a capture with a drop or an incomplete frame is taken again, this often
  // Largest |reported / asked - 1| of an exposure. Darks and lights count as of one exposure up to
  // here, and the reduction divides by the asked one.
  double exposure_tolerance = 1e-4;
  // Beyond the exposure time, until a frame counts as lost.
  std::chrono::milliseconds frame_timeout{5000};
  int frames_per_acknowledgement = 16;  // frames that one fdatasync covers

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

struct RunReport {
  int captures = 0;
  int64_t frames = 0;            // on disk
  int captures_taken_again = 0;  // attempts that were thrown away
};

// The header of a recording of `plan` with `rig`, dated by `clock`.
RecordingHeader MakeHeader(const Rig& rig, const CapturePlan& plan, const Clock& clock);

// Presents, configures, triggers, checks, writes, acknowledges and publishes capture by capture.
// The camera is stopped when this returns.
// A frame passes when it is complete, its camera_frame_id follows the one before, and the exposure
// and gain that it reports are those asked for. Otherwise the capture is taken again.
// Errors: InvalidArgument (empty plan, a setting outside the camera's limits: found before any
// light is measured), Unavailable (a capture that failed `attempts` times: names capture and frame
// id; the camera is lost), Cancelled, those of the presenter and of the writer.
absl::StatusOr<RunReport> RunPlan(Rig& rig, const CapturePlan& plan, RecordingWriter& writer,
                                  const RunOptions& options = {});

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_H_
