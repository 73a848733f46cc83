#include "service/cli/scene_output.h"

#include <cstdio>

#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "service/cli/terminal.h"

namespace eyebox::service::cli {
namespace {

void PrintPatch(const v1::PatchPrediction& patch) {
  std::printf("%s (%s)\n", patch.name().c_str(), patch.material().c_str());
  std::printf("  u %.6g %.6g %.6g   v %.4f %.4f %.4f", patch.u(0), patch.u(1), patch.u(2),
              patch.v(0), patch.v(1), patch.v(2));
  if (patch.has_luminance()) {
    std::printf("   %.5g +- %.2g %s", patch.luminance().value(), patch.luminance().sigma(),
                patch.luminance().unit().c_str());
  }
  for (const v1::Parameter& quantity : patch.tristimulus()) {
    std::printf("   %s %.5g +- %.2g", quantity.name().c_str(), quantity.value(), quantity.sigma());
  }
  if (patch.tristimulus_size() > 0) std::printf(" %s", patch.tristimulus(0).unit().c_str());
  std::printf("\n  evaluated: %s\n", absl::StrJoin(patch.evaluated(), ", ").c_str());
  if (patch.left_out_size() > 0) {
    std::printf("  left out: %s\n", absl::StrJoin(patch.left_out(), "; ").c_str());
  }
  if (patch.balanced_code_size() == 3) {
    std::printf("  white balance of the video: %.1f %.1f %.1f\n", patch.balanced_code(0),
                patch.balanced_code(1), patch.balanced_code(2));
  }
}

}  // namespace

absl::Status RunScene(const SceneRequest& request, bool json) {
  EYEBOX_ASSIGN_OR_RETURN(const v1::ScenePrediction result, PredictScene(request));
  PrintWarnings(result.warnings());
  if (json) return PrintJson(result);
  for (const v1::PatchPrediction& patch : result.patches()) PrintPatch(patch);
  if (result.unused_lights_size() > 0) {
    std::printf("lights that no patch needs: %s\n",
                absl::StrJoin(result.unused_lights(), ", ").c_str());
  }
  std::printf("%s; after shading: %s\n", result.renderer().c_str(),
              absl::StrJoin(result.post_processing(), ", ").c_str());
  PrintParameters(result.parameters());
  return absl::OkStatus();
}

}  // namespace eyebox::service::cli
