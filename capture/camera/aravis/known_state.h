// A camera keeps what the last client left behind. Here everything that decides about counts is
// set, and read back: what cannot be verified is an error, never a hope.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_KNOWN_STATE_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_KNOWN_STATE_H_

#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/pixel_format.h"
#include "capture/camera/aravis/aravis_uri.h"
#include "capture/camera/aravis/device.h"
#include "capture/camera/camera.h"

namespace eyebox::capture::aravis {

// What stays the same from capture to capture.
struct FixedState {
  PixelFormat pixel_format;
  Region region;
  std::optional<double> black_level;  // where CameraSettings asks for none
};

// Chooses pixel format and region as the options ask, else the deepest monochrome format that the
// camera offers and its whole sensor. Leaves the camera stopped and untriggered.
// Errors: InvalidArgument (format not offered, region beyond the sensor), Unavailable.
absl::StatusOr<FixedState> ChooseFixedState(Device& device, const AravisOptions& options);

// Stops the camera, clears all triggers, switches everything automatic and every correction off
// where the camera has it, then sets region, format, exposure, gain, black level, frame rate and
// trigger. Returns what it reads back.
// Errors: Unavailable (names the feature, what was written and what it reads back).
absl::StatusOr<CameraSettings> PushKnownState(Device& device, const FixedState& fixed,
                                              const CameraSettings& settings);

// Which trigger sources CameraInfo may promise.
struct TriggerSources {
  bool software = false;
  std::vector<std::string> lines;
};
absl::StatusOr<TriggerSources> FindTriggerSources(const Device& device);

// In dB. A camera that only has a raw gain of unknown law is held at its lowest: 0 to 0 dB.
absl::StatusOr<Limits<double>> GainLimitsDb(const Device& device);

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_KNOWN_STATE_H_
