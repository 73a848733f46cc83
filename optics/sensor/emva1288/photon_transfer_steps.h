// The sets of a series put in order: which are temporal, which spatial, which dark goes with which.
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_PHOTON_TRANSFER_STEPS_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_PHOTON_TRANSFER_STEPS_H_

#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/sensor/emva1288/evaluate.h"
#include "optics/sensor/emva1288/set_statistics.h"

namespace eyebox::optics {

struct OrderedSets {
  std::vector<const SetStatistics*> temporal_bright;  // by rising irradiation
  std::vector<const SetStatistics*> temporal_dark;    // by rising exposure
  std::vector<const SetStatistics*> spatial_bright;
  std::vector<const SetStatistics*> spatial_dark;
};

// See Emva1288Options::pairs_are_temporal.
OrderedSets OrderSets(std::span<const SetStatistics> sets, bool pairs_are_temporal);

// The dark of this exposure, to 1 part in 1e4; null if there is none.
const SetStatistics* DarkOf(std::span<const SetStatistics* const> darks, double exposure_s);

// Errors: InvalidArgument (no dark of an exposure), FailedPrecondition (fewer than three steps).
absl::StatusOr<std::vector<PhotonTransferStep>> SubtractDarks(const OrderedSets& sets);

// Index of the saturation step: coming down from the highest irradiation, the largest variance
// until two steps in a row lie below it, so that a noisy rise further down is not taken for it.
// The last index if the variance is still rising there.
size_t SaturationStep(std::span<const PhotonTransferStep> steps);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_PHOTON_TRANSFER_STEPS_H_
