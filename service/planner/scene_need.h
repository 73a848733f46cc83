// What a scene asks of a measurement.
#ifndef EYEBOX_SERVICE_PLANNER_SCENE_NEED_H_
#define EYEBOX_SERVICE_PLANNER_SCENE_NEED_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/scene.pb.h"
#include "service/planner/setting.h"
#include "service/scene/read_scene.h"

namespace eyebox::service {

struct SceneNeed {
  Need need;
  bool anywhere = false;              // some patch may be anywhere in the field
  std::vector<std::string> warnings;  // what was taken to be otherwise than the scene has it
};

// `prediction`: of the same scene. `field_deg`: radius of the field that the camera sees. Luminance
// is judged from kDarkestU of white up, and up to white.
inline constexpr double kDarkestU = 0.01;
SceneNeed NeedOf(const SceneInput& scene, const v1::ScenePrediction& prediction, double field_deg);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_SCENE_NEED_H_
