// What a scene asks the display to show, and what the display makes of it.
#ifndef EYEBOX_SERVICE_SCENE_PREDICT_SCENE_H_
#define EYEBOX_SERVICE_SCENE_PREDICT_SCENE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "eyebox/v1/scene.pb.h"

namespace eyebox::service {

struct SceneRequest {
  std::filesystem::path scene;
  std::filesystem::path activation;  // what `eyebox fit --json` printed; empty: no luminances
};

// Errors: those of ReadScene, of the cube and of the activation.
absl::StatusOr<v1::ScenePrediction> PredictScene(const SceneRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCENE_PREDICT_SCENE_H_
