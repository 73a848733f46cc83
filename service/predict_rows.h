// Predicts what a renderer stores for the rows of a CSV file.
#ifndef EYEBOX_SERVICE_PREDICT_ROWS_H_
#define EYEBOX_SERVICE_PREDICT_ROWS_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/predict.pb.h"
#include "fit/renderer/hdrp_model.h"
#include "optics/render/colour_table.h"

namespace eyebox::service {

struct RowPredictionRequest {
  std::filesystem::path csv;
  fit::RowMaterial material = fit::RowMaterial::kLambertian;
  std::filesystem::path cube;  // External table; empty: tonemapping None
  std::filesystem::path out;
  bool published = false;  // the published model, else HdrpModel's default
  std::optional<double> dither_mean_levels;
};

// Writes the rows as they are with u_hat_r, u_hat_g, u_hat_b (scene-linear) and v_hat_r, v_hat_g,
// v_hat_b (in [0, 1] like v, not rounded to 8 bits) appended. Errors: NotFound, InvalidArgument
// naming file, line and column (a column of that name already there included), the errno of the
// disk.
absl::StatusOr<v1::RowPredictionResult> PredictRows(const RowPredictionRequest& request);

// A .cube file as the renderer reads it. Errors: those of ReadCube; InvalidArgument (a domain other
// than 0 to 1).
absl::StatusOr<optics::ColourTable> ReadExternalTable(const std::filesystem::path& file);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREDICT_ROWS_H_
