// GigE Vision and USB3 Vision cameras through Aravis.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_RIG_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_RIG_H_

#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

// What answers now, for the list of devices: uri, vendor, model and serial, nothing else of the
// info. Takes about a second. The in-process fake camera is not among them.
std::vector<CameraInfo> ListAravisCameras();

// config.camera_uri is "aravis:ID?OPTIONS" (options: aravis/aravis_uri.h) or "aravis:fake", a
// camera that Aravis simulates in this process (what it sees: aravis/fake_scene.h).
//
// The camera sets and verifies its whole state in every Configure(). It is lost, and every call
// Unavailable, once its heartbeat fails or it does not answer after a frame failed to arrive:
// destroy it, open the rig anew and configure again. Incomplete frames come without pixels.
// Frames share the camera's buffers: with all of them held, Trigger() is refused.
// The presenter does nothing: whoever runs the headset puts the stimulus there.
// `clock` must outlive the rig and be thread-safe: it stamps frames in the receive thread.
//
// Errors: InvalidArgument (URI, format or region that this camera does not have), NotFound (no
// such camera), Unavailable (names the feature that failed).
absl::StatusOr<Rig> OpenAravisRig(const RigConfig& config, const Clock* clock);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_ARAVIS_RIG_H_
