// A recording played back as if its camera stood there again.
#ifndef EYEBOX_CAPTURE_CAMERA_REPLAY_REPLAY_RIG_H_
#define EYEBOX_CAPTURE_CAMERA_REPLAY_REPLAY_RIG_H_

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

// config.camera_uri is "replay:DIR". The camera has the info of the recorded one, its geometry and
// origin included; only the URI is the one it was opened by.
//
// Present() seeks to the capture whose kind, series, level, stimulus, exposure and gain are those
// of the spec; of several, to the next one that was not presented yet, and after the last to the
// first again. It fails with NotFound where the recording holds none.
// NextFrame() gives its frames in order, pixels and metadata as recorded; Unavailable when there
// are no more, FailedPrecondition when the camera is set to another exposure or gain.
// Memory: the frames of one capture.
//
// Errors: those of RecordingReader::Open(); InvalidArgument (no folder after "replay:").
absl::StatusOr<Rig> OpenReplayRig(const RigConfig& config, const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_REPLAY_REPLAY_RIG_H_
