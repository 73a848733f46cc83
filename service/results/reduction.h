// A reduced bracket as a result message, with its maps.
#ifndef EYEBOX_SERVICE_RESULTS_REDUCTION_H_
#define EYEBOX_SERVICE_RESULTS_REDUCTION_H_

#include <filesystem>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "optics/reduce/reduce_level.h"

namespace eyebox::service {

// Writes luminance.npy, luminance_sigma.npy and mask.npy into `folder` unless it is empty, and
// where scattered light was taken out luminance_scatter_sigma.npy, the part of the sigma that all
// pixels share (see optics::LuminanceImage).
absl::StatusOr<v1::ReduceResult> DescribeReduction(const optics::ReducedLevel& level,
                                                   const optics::Calibration& calibration,
                                                   const std::string& series,
                                                   const std::filesystem::path& folder);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_REDUCTION_H_
