// Whether one exponent serves the field, as a result message and maps.
#ifndef EYEBOX_SERVICE_RESULTS_FIELD_VERDICT_H_
#define EYEBOX_SERVICE_RESULTS_FIELD_VERDICT_H_

#include <filesystem>

#include "absl/status/status.h"
#include "eyebox/v1/results.pb.h"
#include "service/steps/levels.h"

namespace eyebox::service {

// Compares the regions of the field and adds the verdict to `result.field()`, with the maps
// field_gamma.npy and field_gamma_sigma.npy, a value a region, in `folder` unless it is empty.
// Where the field cannot be parted, a warning says why. The regions differ in gamma, and in v0
// where `result` has a cutoff. Errors: those of writing.
absl::Status AddFieldVerdict(const MeasuredLevels& levels, const std::filesystem::path& folder,
                             v1::ActivationResult& result);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_FIELD_VERDICT_H_
