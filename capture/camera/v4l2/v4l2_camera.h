// A camera behind Video4Linux 2, by raw system calls: libv4l2 and OpenCV convert what they deliver.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_CAMERA_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_CAMERA_H_

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/camera/camera.h"
#include "capture/camera/rig.h"
#include "capture/camera/v4l2/video_syscalls.h"

namespace eyebox::capture {

// `uri` is v4l2:/dev/videoN with options, see v4l2_uri.h. `clock` (CLOCK_MONOTONIC, as the driver
// stamps its frames) and `syscalls` must outlive the camera.
//
// The device runs freely; a Trigger() marks a moment, and the next frame that began after it
// answers. Frames that began less than a frame interval after the last write of a setting or the
// start of the stream are passed over. camera_frame_id counts the frames that were asked for, from
// 1 at every Start(); a gap is such a frame that was lost (see frame_gate.h). A spoilt frame comes
// without pixels.
// Frame intervals are as short as the exposure allows. V4L2 tells neither exposure nor gain of a
// single frame, so that these stay empty in its metadata; Configure() returns what reads back.
// The black level is the control of that name or the brightness, in its own unit; its default where
// none is asked for. NextFrame() also fails with Unavailable when a setting changes while frames
// are taken, or when counts exceed what the pixel format allows. Errors: InvalidArgument (URI,
// format), NotFound, PermissionDenied, ResourceExhausted (another program streams), Unavailable
// (the driver alters what was asked, keeps something automatic, has no exposure time or tells no
// frame interval).
absl::StatusOr<std::unique_ptr<Camera>> OpenV4l2Camera(
    std::string_view uri, const Clock* clock, VideoSyscalls* syscalls = KernelVideoSyscalls());

// The same on config.camera_uri, with a presenter that does nothing.
absl::StatusOr<Rig> OpenV4l2Rig(const RigConfig& config, const Clock* clock);

struct V4l2Listing {
  std::string uri;
  std::string card;
  std::string driver;
  std::string bus;
  std::vector<std::string> formats;  // raw ones
  std::string problem;               // why it cannot be used; empty where it can
};

// Every node named videoN in `folder`, by number. Nothing is written to the devices.
std::vector<V4l2Listing> ListV4l2Cameras(const std::filesystem::path& folder = "/dev",
                                         VideoSyscalls* syscalls = KernelVideoSyscalls());

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_V4L2_CAMERA_H_
