// What Unity's HDRP stores for a patch: the published model, and what its buffers and its grading
// table add to it.
#ifndef EYEBOX_FIT_RENDERER_HDRP_MODEL_H_
#define EYEBOX_FIT_RENDERER_HDRP_MODEL_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/renderer/scene_row.h"
#include "optics/render/render_pipeline.h"

namespace eyebox::fit {

enum class ColorBuffer { kExact, kPackedTruncated, kPackedRounded, kHalf };
enum class TableAxis {
  kLogC,           // through HDRP's internal grading table
  kPublishedKnots  // linear in u between the knots of table 2(b), only where there is a cube
};

// Value type; the defaults are what predicts held-out rows best (fit/renderer/README.md).
struct HdrpModel {
  // c of eq 2. HDRP turns EV100 into a factor 1 / (1.2 2^EV100); published: 0.822.
  double light_scale = 1 / 1.2;
  // Added to c s(m): what a black Lambertian surface still reflects of both lights.
  double reflectance_floor = 0.0003;
  // Reflected directional and ambient light are each stored in the colour buffer's format before
  // they are added.
  bool stores_lights_apart = true;
  // HDRP dithers with the same noise in all channels before it rounds to 8 bits. Its mean over the
  // frames at the pixel looked at, in levels of 1/255; 0 if the pixel is another than that of the
  // captures it was fitted to, for which it is -0.08 +- 0.03.
  double dither_mean_levels = -0.08;
  ColorBuffer buffer = ColorBuffer::kPackedTruncated;
  TableAxis axis = TableAxis::kLogC;
  bool grading_through_hsv = true;
  bool half_float_table = true;

  // Equations 2 to 4 as printed.
  static HdrpModel Published();
};

// Of one patch. v is encoded and clamped to [0, 1] but not rounded to 8 bits: HDRP dithers with
// triangular noise of one level before it rounds, so this is the mean of what it stores.
struct RowPrediction {
  optics::Rgb unprocessed = {};  // u
  optics::Rgb stored = {};       // v
};

// Ready to predict many rows through one table.
class HdrpRenderer {
 public:
  // `cube`: entries of an External table, may be null (tonemapping None). Its size is taken as the
  // project's grading table size, 32 without a cube. Errors: InvalidArgument (size other than 32
  // with kPublishedKnots; entries that are not size^3; a size outside 2 to 129).
  static absl::StatusOr<HdrpRenderer> Create(const HdrpModel& model,
                                             const optics::ColourTable* cube);

  // Other values of what is fitted; the table stays.
  void SetParameters(double light_scale, double reflectance_floor, double dither_mean_levels);
  RowPrediction Predict(const SceneRow& row, RowMaterial material) const;
  // The terms of eq 2 and 3 that the row's scene has: "material", "directional light", ...
  std::vector<std::string> Terms(const std::vector<SceneRow>& rows, RowMaterial material) const;
  // What follows shading, in order.
  const optics::RenderPipeline& Stages() const { return stages_; }

 private:
  optics::Rgb Stored(const optics::Rgb& color) const;
  optics::Rgb Shade(const SceneRow& row) const;

  HdrpModel model_;
  optics::RenderPipeline buffer_;  // one stage or none
  optics::RenderPipeline stages_;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_RENDERER_HDRP_MODEL_H_
