// What stands in recording.textproto: written once, before the first frame.
#ifndef EYEBOX_CAPTURE_RECORDING_HEADER_H_
#define EYEBOX_CAPTURE_RECORDING_HEADER_H_

#include <cstdint>
#include <optional>
#include <string>

#include "capture/base/capture_spec.h"
#include "capture/base/geometry.h"
#include "capture/camera/camera.h"
#include "capture/camera/rig.h"

namespace eyebox::capture {

using eyebox::PinholeGeometry;

struct RecordingHeader {
  RecordingOrigin origin = RecordingOrigin::kCaptured;
  RigConfig rig;
  CameraInfo camera;
  std::optional<PinholeGeometry> geometry;
  CapturePlan plan;
  std::string software_version;
  int64_t created_real_ns = 0;  // CLOCK_REALTIME
  // What holds throughout; exposure_s and gain_db stand with each capture and are not kept here.
  std::optional<CameraSettings> camera_settings = {};
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_HEADER_H_
