// Rows of a plane under a directional and an ambient light, as each of Unity's renderers shows
// them.
#ifndef EYEBOX_SERVICE_SCENE_RENDER_ROWS_H_
#define EYEBOX_SERVICE_SCENE_RENDER_ROWS_H_

#include <filesystem>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/renderer/hdrp_model.h"
#include "optics/render/scene/scene.h"

namespace eyebox::service {

struct RowRendering {
  std::vector<fit::RowPrediction> predictions;  // [rows]
  std::vector<std::string> terms;               // that any row needed
  std::vector<std::string> stages;              // after shading, in order
  int table_size = 0;                           // of `table`, 0 without
};

struct RowRenderer {
  optics::Renderer renderer = optics::Renderer::kHdrp;
  fit::HdrpModel model;         // of HDRP alone
  std::filesystem::path table;  // as in PostProcessingOf
};

// Errors: those of PostProcessingOf; InvalidArgument naming `file` and the row with an exposure
// other than 0, which only HDRP has.
absl::StatusOr<RowRendering> RenderRows(const std::vector<fit::SceneRow>& rows,
                                        fit::RowMaterial material, const RowRenderer& with,
                                        const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCENE_RENDER_ROWS_H_
