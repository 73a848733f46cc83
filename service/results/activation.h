// An activation fit as a result message, and back.
#ifndef EYEBOX_SERVICE_RESULTS_ACTIVATION_H_
#define EYEBOX_SERVICE_RESULTS_ACTIVATION_H_

#include <filesystem>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "fit/activation/fit_activation.h"
#include "fit/field/common_exponent.h"
#include "service/steps/levels.h"

namespace eyebox::service {

// Everything but `field`.
v1::ActivationResult DescribeActivation(const fit::ActivationChoice& choice,
                                        const fit::LevelSeries& series);

// The table of all models under all weightings, into `comparison`.
void AddComparison(const std::vector<fit::ComparedActivation>& compared,
                   v1::ActivationResult& result);

// Writes field_k.npy, field_k_sigma.npy, field_delta.npy and field_delta_sigma.npy into `folder`
// unless it is empty.
absl::StatusOr<v1::CommonExponentResult> DescribeField(const fit::CommonExponentFit& fit,
                                                       const MeasuredLevels& levels,
                                                       const std::filesystem::path& folder);

// L0 + L1, "maximum_luminance"; its sigma, like theirs, holds that of the luminance scale.
v1::Parameter MaximumLuminance(const v1::ActivationResult& activation);

// Errors: InvalidArgument naming `where` and the parameter that is absent or out of range.
absl::StatusOr<fit::Activation> ActivationOf(const v1::ActivationResult& result,
                                             std::string_view where);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_ACTIVATION_H_
