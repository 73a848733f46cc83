// What every camera can do. Sim and replay are siblings of the real ones; one contract suite
// (tests/contract) runs on all of them.
#ifndef EYEBOX_CAPTURE_CAMERA_CAMERA_H_
#define EYEBOX_CAPTURE_CAMERA_CAMERA_H_

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/frame.h"
#include "capture/base/geometry.h"

namespace eyebox::capture {

struct CameraInfo {
  std::string uri;     // as opened, for example "sim:rift-s-like"
  std::string vendor;  // empty where unknown
  std::string model;
  std::string serial;
  ImageSize sensor_size;
  int significant_bits = 0;  // of the counts; full scale is 2^bits - 1 DN
  double exposure_min_s = 0;
  double exposure_max_s = 0;
  double gain_min_db = 0;
  double gain_max_db = 0;
  std::optional<PinholeGeometry> geometry = {};  // where the optics are known
  // PFNC name on the wire, "Mono12p" or "BayerRG8"; counts arrive unpacked, a mosaic stays one.
  std::string pixel_format = {};  // empty where there is no wire
  double black_level_min = 0;     // in the device's own unit; both 0: it has no such setting
  double black_level_max = 0;
  bool software_trigger = true;
  std::vector<std::string> trigger_lines = {};  // "Line0", ...; empty: no hardware trigger
  bool free_run = false;
};

enum class TriggerSource {
  kSoftware,  // Trigger() starts each exposure
  kLine,      // a rising edge on `trigger_line` does; Trigger() is refused
  kFreeRun,   // the camera itself, one exposure after another
};

// The complete state that a capture depends on; everything automatic is off by definition.
struct CameraSettings {
  double exposure_s = 0.01;
  double gain_db = 0;
  TriggerSource trigger = TriggerSource::kSoftware;
  std::string trigger_line = {};           // with kLine: one of CameraInfo::trigger_lines
  double frame_rate_hz = 0;                // with kFreeRun; 0: as fast as the exposure allows
  std::optional<double> black_level = {};  // the device's unit; empty: as it was when opened
  friend bool operator==(const CameraSettings&, const CameraSettings&) = default;
};

// Not thread-safe: one thread at a time. Frames it returned may outlive it.
class Camera {
 public:
  virtual ~Camera() = default;

  virtual const CameraInfo& Info() const = 0;

  // Pushes the whole state and returns what the device reads back. Only while stopped.
  // Errors: InvalidArgument (outside the limits of Info(), names the field), Unavailable,
  // FailedPrecondition (running).
  virtual absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings) = 0;

  // Ready for triggers. Errors: FailedPrecondition (running or never configured), Unavailable.
  virtual absl::Status Start() = 0;

  // Starts one exposure. Errors: FailedPrecondition (not started, not triggered by software),
  // Unavailable.
  virtual absl::Status Trigger() = 0;

  // The next frame in order of exposure, complete or not: look at metadata.status. An incomplete
  // one may come without pixels.
  // Errors: DeadlineExceeded (nothing came), FailedPrecondition (not started), Unavailable (lost).
  virtual absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout) = 0;

  // Drops what is pending. Stopping a stopped camera is not an error.
  virtual absl::Status Stop() = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_CAMERA_H_
