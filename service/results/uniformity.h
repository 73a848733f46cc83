// A uniformity map as a result message, with its maps.
#ifndef EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_
#define EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_

#include <filesystem>
#include <optional>

#include "absl/status/statusor.h"
#include "capture/recording/header.h"
#include "eyebox/v1/results.pb.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::service {

// Writes uniformity_g.npy, uniformity_g_sigma.npy, uniformity_g_smooth.npy and
// uniformity_g_smooth_sigma.npy into `folder` unless it is empty.
absl::StatusOr<v1::UniformityResult> DescribeUniformity(
    const optics::UniformityMap& map, const optics::LuminanceImage& full_field,
    double reference_drive, const std::optional<capture::PinholeGeometry>& geometry,
    const std::filesystem::path& folder);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_UNIFORMITY_H_
