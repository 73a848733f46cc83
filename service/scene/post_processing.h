// What each of Unity's renderers does to a colour after shading.
#ifndef EYEBOX_SERVICE_SCENE_POST_PROCESSING_H_
#define EYEBOX_SERVICE_SCENE_POST_PROCESSING_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "fit/renderer/hdrp_model.h"
#include "optics/render/render_pipeline.h"
#include "optics/render/scene/scene.h"

namespace eyebox::service {

struct PostProcessing {
  optics::RenderPipeline lights_apart;  // what direct and ambient light pass before they are added
  optics::RenderPipeline stages;        // what their sum passes

  optics::Rgb Stored(const optics::ShadedParts& parts) const;
};

// `table`: HDRP's External tonemapping (.cube), the Post-Processing Stack's or URP's lookup texture
// (strip PNG, looked up with the encoded colour); empty: none. `model` matters to HDRP alone.
// Errors: those of ReadExternalTable and ReadStrip; InvalidArgument (a table of the other kind).
absl::StatusOr<PostProcessing> PostProcessingOf(optics::Renderer renderer,
                                                const fit::HdrpModel& model,
                                                const std::filesystem::path& table);

// A .cube file as HDRP reads it. Errors: those of ReadCube; InvalidArgument (a domain other than 0
// to 1).
absl::StatusOr<optics::ColourTable> ReadExternalTable(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SCENE_POST_PROCESSING_H_
