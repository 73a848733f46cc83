// Where the knots of a table lie, and which model of the renderer explains rendered rows.
#ifndef EYEBOX_SERVICE_COMPARE_RENDERERS_H_
#define EYEBOX_SERVICE_COMPARE_RENDERERS_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/predict.pb.h"
#include "fit/renderer/delta_sweep.h"

namespace eyebox::service {

struct KnotsRequest {
  std::filesystem::path sweep;  // cube,u,t; empty: none, unless simulated
  int size = 32;
  bool simulates = false;           // a renderer that samples in LogC instead of a file
  bool packed_buffers = false;      // of the simulated one
  std::filesystem::path sweep_out;  // where the simulated sweep is written; may be empty
  std::vector<std::string> rows;    // "MATERIAL,FILE[,CUBE]"
  int folds = 10;
};

// Errors: NotFound, InvalidArgument, FailedPrecondition (a sweep that fixes no knots).
absl::StatusOr<v1::KnotsResult> CompareRenderers(const KnotsRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_COMPARE_RENDERERS_H_
