// Controls of a V4L2 device: whole numbers with a name and limits.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_CONTROLS_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_CONTROLS_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/v4l2/v4l2_uri.h"
#include "capture/camera/v4l2/video_node.h"

namespace eyebox::capture {

struct Control {
  uint32_t id = 0;
  std::string name;  // as the driver says, for example "Exposure Time, Absolute"
  int32_t minimum = 0;
  int32_t maximum = 0;
  int32_t step = 1;
  int32_t default_value = 0;
  bool read_only = false;
};

// A control and the value that it must keep while frames are taken.
struct HeldControl {
  Control control;
  int32_t value = 0;
};

// Empty: the device has no such control. Errors: Unavailable.
absl::StatusOr<std::optional<Control>> FindControl(const VideoNode& node, uint32_t id);
// Errors: Unavailable.
absl::StatusOr<int32_t> ReadControl(const VideoNode& node, const Control& control);
// Writes the value (unless the control is read-only) and returns what is read back.
// Errors: Unavailable, naming the control.
absl::StatusOr<int32_t> WriteControl(const VideoNode& node, const Control& control, int32_t value);

// Switches off everything that the device does by itself, puts what else changes the picture into a
// known state, reads all of it back and returns it. What the device does not have is passed over.
// Errors: Unavailable (a control keeps another value: names it), InvalidArgument (a gamma whose
// linear value is not known).
absl::StatusOr<std::vector<HeldControl>> MakeManual(const VideoNode& node,
                                                    const V4l2Options& options);

// The exposure control, in units of 100 us. Errors: Unavailable (the device has none).
absl::StatusOr<Control> FindExposureControl(const VideoNode& node);
// The analogue gain, else the gain; empty where the device has neither.
absl::StatusOr<std::optional<Control>> FindGainControl(const VideoNode& node);
// The black level, else the brightness; empty where the device has neither.
absl::StatusOr<std::optional<Control>> FindBlackLevelControl(const VideoNode& node);

// Asks the driver to tell when one of these has or gets another value. A driver without events
// stays silent.
void WatchControls(const VideoNode& node, std::span<const HeldControl> held);
// Reads the pending events. Errors: Unavailable (a held control changed: names it).
absl::Status CheckWatched(const VideoNode& node, std::span<const HeldControl> held);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_VIDEO_CONTROLS_H_
