#include "service/compare_renderers.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "fit/renderer/compare_models.h"
#include "service/results/renderer.h"
#include "service/scene/post_processing.h"

namespace eyebox::service {
namespace {

absl::StatusOr<fit::DeltaSweep> SweepOf(const KnotsRequest& request) {
  if (!request.simulates) return fit::ReadDeltaSweep(request.sweep, request.size);
  fit::SweepOptions options;
  options.size = request.size;
  options.packed_buffers = request.packed_buffers;
  EYEBOX_ASSIGN_OR_RETURN(fit::DeltaSweep sweep, fit::SimulateDeltaSweep(options));
  if (!request.sweep_out.empty()) {
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.sweep_out, fit::EncodeDeltaSweep(sweep)));
  }
  return sweep;
}

absl::StatusOr<fit::RenderedSet> SetOf(const std::string& text) {
  const std::vector<std::string> parts = absl::StrSplit(text, ',');
  fit::RenderedSet set;
  if (parts.size() < 2 || parts.size() > 3 || (parts[0] != "unlit" && parts[0] != "lambertian")) {
    return BadInput(absl::StrCat("--rows ", text), "not MATERIAL,FILE[,CUBE]",
                    "give for example lambertian,rows.csv,lut.cube");
  }
  set.material = parts[0] == "unlit" ? fit::RowMaterial::kUnlit : fit::RowMaterial::kLambertian;
  set.name = std::filesystem::path(parts[1]).filename().string();
  EYEBOX_ASSIGN_OR_RETURN(set.rows, fit::ReadSceneRows(parts[1], set.material));
  if (parts.size() == 3) {
    EYEBOX_ASSIGN_OR_RETURN(set.cube, ReadExternalTable(parts[2]));
  }
  return set;
}

}  // namespace

absl::StatusOr<v1::KnotsResult> CompareRenderers(const KnotsRequest& request) {
  v1::KnotsResult result;
  if (request.simulates || !request.sweep.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(const fit::DeltaSweep sweep, SweepOf(request));
    EYEBOX_ASSIGN_OR_RETURN(const fit::RecoveredKnots knots, fit::RecoverKnots(sweep));
    DescribeKnots(knots, result);
  }
  if (request.rows.empty()) return result;
  std::vector<fit::RenderedSet> sets;
  for (const std::string& text : request.rows) {
    EYEBOX_ASSIGN_OR_RETURN(fit::RenderedSet set, SetOf(text));
    sets.push_back(std::move(set));
  }
  fit::ComparisonOptions options;
  options.folds = request.folds;
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<fit::ComparedModel> models,
                          fit::CompareModels(sets, fit::StandardHypotheses(), options));
  DescribeModels(models, result);
  return result;
}

}  // namespace eyebox::service
