// Which model of the renderer predicts rows that it was not fitted to, and with which c.
#ifndef EYEBOX_FIT_RENDERER_COMPARE_MODELS_H_
#define EYEBOX_FIT_RENDERER_COMPARE_MODELS_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/base/parameter.h"
#include "fit/renderer/hdrp_model.h"

namespace eyebox::fit {

// Rows rendered through one cube, or none.
struct RenderedSet {
  std::string name;
  RowMaterial material = RowMaterial::kLambertian;
  std::vector<SceneRow> rows;  // rows without `stored` are left out
  std::optional<optics::ColourTable> cube;
};

struct Hypothesis {
  std::string name;
  HdrpModel model;           // what is not fitted keeps its value here
  bool fits_scale = false;   // light_scale
  bool fits_floor = false;   // reflectance_floor
  bool fits_dither = false;  // dither_mean_levels; slow together with light_scale
  bool competes = true;      // false: its values come from elsewhere, perhaps from these rows
};
// From the published model, one mechanism more in each; the last is HdrpModel's default.
std::vector<Hypothesis> StandardHypotheses();

// |predicted - stored| and predicted - stored over the channels of a set, unit 1/255.
struct SetError {
  std::string set;
  int values = 0;
  double median = 0;
  double mean = 0;
  optics::Rgb bias = {};        // mean of predicted - stored
  optics::Rgb bias_sigma = {};  // its standard error
  double worst = 0;             // largest of them
  int worst_row = -1;           // where it lies
};

struct ComparedModel {
  Hypothesis hypothesis;
  std::vector<Parameter> parameters;  // light_scale, reflectance_floor, dither_mean; of all rows
  std::vector<SetError> held_out;     // each row predicted by the fit to the other folds
  std::vector<SetError> in_sample;
  double mean_held_out = 0;  // mean of the sets' means: what models are ranked by
  optics::Rgb bias = {};     // of all sets together, held out
};

struct ComparisonOptions {
  int folds = 10;  // row i of a set belongs to fold i mod folds
  // A value further off than this counts as this far, so that a faulty capture moves nothing;
  // unit 1/255.
  double loss_limit = 2;
  int bootstrap_samples = 200;  // for the sigmas
};

// Searches light_scale over 0.78 to 0.88 and reflectance_floor over 0 to 0.0015
// and dither_mean_levels over -0.3 to 0.3 on a grid, because
// truncation makes the error a staircase of both. One set of parameters serves all sets.
// Errors: InvalidArgument (no set, a set with fewer rows with v than folds, options, a cube).
absl::StatusOr<std::vector<ComparedModel>> CompareModels(const std::vector<RenderedSet>& sets,
                                                         const std::vector<Hypothesis>& hypotheses,
                                                         const ComparisonOptions& options = {});

// Of predictions in the order of the rows that have `stored`.
SetError ErrorOf(const RenderedSet& set, const std::vector<optics::Rgb>& predicted);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_RENDERER_COMPARE_MODELS_H_
