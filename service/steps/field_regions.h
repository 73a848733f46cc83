// The field in a grid of regions, for the question whether one exponent serves it.
#ifndef EYEBOX_SERVICE_STEPS_FIELD_REGIONS_H_
#define EYEBOX_SERVICE_STEPS_FIELD_REGIONS_H_

#include "absl/status/statusor.h"
#include "fit/field/exponent_by_region.h"
#include "service/steps/levels.h"

namespace eyebox::service {

constexpr int kRegionsPerSide = 3;

struct FieldRegions {
  int rows = kRegionsPerSide;
  int columns = kRegionsPerSide;
  fit::RegionComparison comparison;  // region r x columns + c; regions without light are absent
};

// Averages the valid pixels in cells, 12 a side in each region: neighbouring pixels share an
// optical spot, and the F test wants independent readings. Errors that all places share at a level
// make the test more careful, not less. `with_cutoff`: regions differ in gamma and v0. Errors:
// FailedPrecondition (fewer than 2 regions with light, or those of the fits).
absl::StatusOr<FieldRegions> CompareFieldRegions(const MeasuredLevels& levels, bool with_cutoff);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_FIELD_REGIONS_H_
