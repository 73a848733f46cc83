#include "capture/camera/rig.h"

#include <array>
#include <string_view>

#include "capture/base/status.h"
#include "capture/camera/aravis/aravis_rig.h"
#include "capture/camera/replay/replay_rig.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/camera/v4l2/v4l2_camera.h"

namespace eyebox::capture {
namespace {

absl::StatusOr<Rig> OpenSim(const RigConfig& config, const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(const SimParameters parameters, SimParametersOf(config));
  return OpenSimRig(config, parameters, clock);
}

struct Scheme {
  std::string_view name;
  absl::StatusOr<Rig> (*open)(const RigConfig&, const Clock*);
};

constexpr std::array kSchemes = {Scheme{"sim", OpenSim}, Scheme{"replay", OpenReplayRig},
                                 Scheme{"aravis", OpenAravisRig}, Scheme{"v4l2", OpenV4l2Rig}};

absl::StatusOr<Rig> OpenCamera(const RigConfig& config, const Clock* clock) {
  const std::string_view uri = config.camera_uri;
  for (const Scheme& scheme : kSchemes) {
    if (uri.starts_with(scheme.name) && uri.substr(scheme.name.size()).starts_with(':')) {
      return scheme.open(config, clock);
    }
  }
  std::string known;
  for (const Scheme& scheme : kSchemes) known.append(" ").append(scheme.name).append(":");
  return BadInput("camera_uri '" + config.camera_uri + "'", "has no scheme that is known here",
                  "start it with one of" + known);
}

}  // namespace

absl::StatusOr<Rig> OpenRig(const RigConfig& config, const Clock* clock) {
  EYEBOX_ASSIGN_OR_RETURN(Rig rig, OpenCamera(config, clock));
  if (!config.photodiode_uri.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(
        rig.photodiode, OpenPhotodiode({.uri = config.photodiode_uri, .seed = config.seed}, clock));
  }
  if (!config.trigger_uri.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(rig.trigger, OpenTrigger(config.trigger_uri, clock));
  }
  return rig;
}

std::vector<std::string> CameraSchemes() {
  std::vector<std::string> names;
  for (const Scheme& scheme : kSchemes) names.emplace_back(scheme.name);
  return names;
}

}  // namespace eyebox::capture
