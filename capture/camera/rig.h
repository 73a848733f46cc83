// A rig is what one measures with: here the camera and whatever shows the stimuli.
#ifndef EYEBOX_CAPTURE_CAMERA_RIG_H_
#define EYEBOX_CAPTURE_CAMERA_RIG_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/clock.h"
#include "capture/camera/camera.h"
#include "capture/photodiode/photodiode.h"
#include "capture/trigger/trigger.h"

namespace eyebox::capture {

// Puts the scene of a capture before the camera and returns once it is there. The simulator draws
// it, a replay seeks to it; with hardware the experimenter's script does it.
class StimulusPresenter {
 public:
  virtual ~StimulusPresenter() = default;
  // Errors: NotFound (a replay that holds no such capture), Unavailable, Cancelled.
  virtual absl::Status Present(const CaptureSpec& spec) = 0;
};

// Where the frames of a recording come from.
enum class RecordingOrigin {
  kCaptured,   // by Eyebox, from a device
  kSimulated,  // by Eyebox, from the simulator
  kImported,   // frames taken by other software
};

struct RigConfig {
  std::string name;                 // resource name, [a-z0-9-]
  std::string camera_uri;           // "aravis:ID", "sim:NAME", ...; see CameraSchemes()
  uint64_t seed = 1;                // of everything random in a simulated rig
  std::string photodiode_uri = {};  // as OpenPhotodiode() takes it; empty: none
  std::string trigger_uri = {};     // as OpenTrigger() takes it; empty: none
  // The camera's input that the trigger is wired to, one of CameraInfo::trigger_lines; empty: its
  // pulses reach the photodiode alone.
  std::string camera_trigger_line = {};
  std::string sensor = {};  // folder of the camera's characterisation; empty: none
};

// Camera and presenter may share state (a simulated headset), which lives as long as either.
struct Rig {
  RigConfig config;
  RecordingOrigin origin = RecordingOrigin::kCaptured;  // a replay passes on what it replays
  std::unique_ptr<Camera> camera;
  std::unique_ptr<StimulusPresenter> presenter;
  std::unique_ptr<Photodiode> photodiode = nullptr;  // null where config names none
  std::unique_ptr<Trigger> trigger = nullptr;        // likewise
};

// Opens what the URIs of camera, photodiode and trigger name. `clock` must outlive the rig.
// Errors: InvalidArgument (unknown scheme: lists the known ones), NotFound, Unavailable.
absl::StatusOr<Rig> OpenRig(const RigConfig& config, const Clock* clock);

// "sim", "replay", ... in the order in which `eyebox devices` lists them.
std::vector<std::string> CameraSchemes();

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_RIG_H_
