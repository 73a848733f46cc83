// What a person reads of a predicted scene.
#ifndef EYEBOX_SERVICE_CLI_SCENE_OUTPUT_H_
#define EYEBOX_SERVICE_CLI_SCENE_OUTPUT_H_

#include "absl/status/status.h"
#include "service/scene/predict_scene.h"

namespace eyebox::service::cli {

// Predicts and prints: a table of patches with the terms that were evaluated and left out, or JSON.
// Errors: those of PredictScene.
absl::Status RunScene(const SceneRequest& request, bool json);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_SCENE_OUTPUT_H_
