// Carries out a plan: every capture ends up complete on disk, or the run fails and says where.
#ifndef EYEBOX_CAPTURE_RUN_H_
#define EYEBOX_CAPTURE_RUN_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/clock.h"
#include "capture/camera/rig.h"
#include "capture/recording/header.h"
#include "capture/recording/writer.h"
#include "capture/run/reading_log.h"
#include "capture/run/settle.h"

namespace eyebox::capture {

struct RunProgress {
  int captures_done = 0;
  int captures_total = 0;
  const CaptureSpec& next;  // the capture that begins now
};

// A capture that was just published, as the run saw it.
struct CaptureFigures {
  Reading reading;
  int attempts = 1;
  std::optional<Settling> settling = {};  // empty where the scene was there before
  std::string remark = {};                // what the experimenter should know; mostly empty
};

struct RunOptions {
  std::function<void(const RunProgress&)> progress = nullptr;  // before every capture
  std::function<bool()> cancelled = nullptr;                   // asked before every frame
  // After every capture. An error ends the run.
  std::function<absl::Status(const CaptureFigures&)> published = nullptr;
  int attempts = 3;  // a capture with a drop or an incomplete frame is taken again, this often
  // Largest |reported / asked - 1| of an exposure. Darks and lights count as of one exposure up to
  // here, and the reduction divides by the asked one.
  double exposure_tolerance = 1e-4;
  // Beyond the exposure time, until a frame counts as lost.
  std::chrono::milliseconds frame_timeout{5000};
  int frames_per_acknowledgement = 16;  // frames that one fdatasync covers
  // How long to wait after each new scene; empty: not at all (a replay has no frames to spare).
  std::optional<SettleOptions> settle = std::nullopt;
  PlausibilityOptions plausibility = {};
  int implausible_attempts = 2;  // a patch that reads implausibly is taken again, this often
  // Readings of earlier sessions of the recording, in the order of their capture.
  std::vector<Reading> earlier = {};
  // Opens a camera that was lost anew, once in a run; the old one is gone by then. Not set: a lost
  // camera ends the run.
  std::function<absl::StatusOr<std::unique_ptr<Camera>>()> reopen = nullptr;
  // Of the rig's photodiode, if it has one; the nearest that it can do.
  double photodiode_rate_hz = 1000;
  // Of the rig's trigger, if it has one: one pulse a frame. A photodiode that pulses can start then
  // converts once a frame; the camera is triggered by the pulse if the rig says so, else by
  // software right after it.
  std::chrono::microseconds trigger_pulse{100};
  const Clock* clock = SystemClock();  // of the clock triples; that of the rig

  // Errors: InvalidArgument (names the field).
  absl::Status Validate() const;
};

struct RunReport {
  int captures = 0;
  int64_t frames = 0;            // on disk
  int64_t samples = 0;           // of the photodiode, on disk
  int captures_taken_again = 0;  // attempts that were thrown away
  int implausible = 0;           // of these, those that read implausibly
  int cameras_reopened = 0;
  std::vector<std::string> remarks = {};  // those of the captures, each with its number
};

// The header of a recording of `plan` with `rig`, dated by `clock`.
RecordingHeader MakeHeader(const Rig& rig, const CapturePlan& plan, const Clock& clock);

// Presents, configures, waits until the scene has settled, triggers, checks, writes, acknowledges
// and publishes capture by capture. The camera is stopped when this returns.
//
// A frame passes when it is complete, its camera_frame_id follows the one before, and the exposure
// and gain that it reports are those asked for. Otherwise the capture is taken again. So is a patch
// that is brighter than a brighter one was (afterglow), up to `implausible_attempts` times; then it
// is kept with a remark. A reference patch that lost much of its light at once tells that the
// headset slept or dimmed: it and all since the reference before are marked suspect in the
// recording, and the run ends.
//
// A photodiode runs from before the first trigger of a capture to its last frame. Its samples and
// two clock triples, one at each end, stand with the frames; samples that find no room are told in
// a remark. If it fails, the capture is taken again, as it is for a lost frame.
//
// To resume a recording, give what RemainingCaptures() names as the plan, a resumed writer and the
// earlier readings.
//
// Errors: InvalidArgument (empty plan, a setting outside the camera's limits: found before any
// light is measured), Unavailable (a capture that failed `attempts` times: names capture and frame
// id; the camera is lost; the headset slept: names the first suspect capture), Cancelled, those of
// the presenter, of the writer and of `published`. Captures are numbered as their files are.
absl::StatusOr<RunReport> RunPlan(Rig& rig, const CapturePlan& plan, RecordingWriter& writer,
                                  const RunOptions& options = {});

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_H_
