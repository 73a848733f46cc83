// A uniformity map as a result message, with its maps.
#ifndef EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_
#define EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/recording/header.h"
#include "eyebox/v1/results.pb.h"
#include "optics/scatter/known_glare.h"
#include "optics/uniformity/level_independence.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::service {

// Writes g raw and smooth, and the smooth model of the other kind, each with its sigma, as
// uniformity_g*.npy into `folder` unless it is empty.
absl::StatusOr<v1::UniformityResult> DescribeUniformity(
    const optics::UniformityMap& map, const optics::LuminanceImage& full_field,
    double reference_drive, const std::optional<capture::PinholeGeometry>& geometry,
    const std::filesystem::path& folder);

void AddScatterRemoval(const optics::GlareRemovalFigures& figures, v1::UniformityResult& result);

// The test, or why there is none; its map uniformity_level_p_value.npy likewise.
absl::Status AddLevelIndependence(const absl::StatusOr<optics::LevelIndependence>& test,
                                  int block_px, const std::filesystem::path& folder,
                                  v1::UniformityResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_
