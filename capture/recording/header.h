// What stands in recording.textproto: written once, before the first frame.
#ifndef EYEBOX_CAPTURE_RECORDING_HEADER_H_
#define EYEBOX_CAPTURE_RECORDING_HEADER_H_

#include <cstdint>
#include <optional>
#include <string>

#include "capture/base/capture_spec.h"
#include "capture/camera/camera.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

enum class RecordingOrigin {
  kCaptured,   // by Eyebox, from a device
  kSimulated,  // by Eyebox, from the simulator
  kImported,   // frames taken by other software
};

// Ideal pinhole: field angle = atan((pixel - principal point) / focal length).
struct PinholeGeometry {
  double focal_length_px = 0;
  double principal_x_px = 0;  // pixel centres are at whole numbers
  double principal_y_px = 0;
};

struct RecordingHeader {
  RecordingOrigin origin = RecordingOrigin::kCaptured;
  RigConfig rig;
  CameraInfo camera;
  std::optional<PinholeGeometry> geometry;
  CapturePlan plan;
  std::string software_version;
  int64_t created_real_ns = 0;  // CLOCK_REALTIME
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_HEADER_H_
