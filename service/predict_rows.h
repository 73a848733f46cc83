// Predicts what a renderer stores for the rows of a CSV file.
#ifndef EYEBOX_SERVICE_PREDICT_ROWS_H_
#define EYEBOX_SERVICE_PREDICT_ROWS_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/predict.pb.h"
#include "fit/renderer/hdrp_model.h"
#include "optics/render/scene/scene.h"

namespace eyebox::service {

struct RowPredictionRequest {
  std::filesystem::path csv;
  fit::RowMaterial material = fit::RowMaterial::kLambertian;
  optics::Renderer renderer = optics::Renderer::kHdrp;
  std::filesystem::path cube;  // HDRP: External table; else a strip PNG; empty: none
  std::filesystem::path out;
  // HDRP alone: the published model, else HdrpModel's default.
  bool published = false;
  std::optional<double> dither_mean_levels;
  std::filesystem::path activation;  // what `eyebox fit --json` printed; empty: no luminances
};

// Writes the rows as they are with u_hat_r, u_hat_g, u_hat_b (scene-linear) and v_hat_r, v_hat_g,
// v_hat_b (in [0, 1] like v; of HDRP not rounded to 8 bits, as it dithers) appended, and with an
// activation luminance_hat and luminance_hat_sigma, or x_hat, x_hat_sigma, .., z_hat_sigma of a
// display fitted in colour. A field is empty where the display does not tell: coloured drives of
// one that was measured in grey. Errors: NotFound, InvalidArgument naming file, line and column (a
// column of that name already there included), the errno of the disk.
absl::StatusOr<v1::RowPredictionResult> PredictRows(const RowPredictionRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREDICT_ROWS_H_
