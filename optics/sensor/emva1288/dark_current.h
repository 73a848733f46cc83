// What the darks say of exposure time and temperature.
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_DARK_CURRENT_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_DARK_CURRENT_H_

#include <optional>
#include <span>

#include "optics/sensor/emva1288/evaluate.h"
#include "optics/sensor/emva1288/set_statistics.h"

namespace eyebox::optics {

// Temporal variance of the dark at exposure 0, DN^2, by a straight line over the exposures.
// Empty for fewer than three exposures.
std::optional<Quantity> DarkVarianceAtZero(std::span<const SetStatistics* const> darks);

// mu_I, e/s, by straight lines of the dark's mean and variance over the exposures; where all
// darks have a temperature and these span 2 K or more, mean = bias + t (mu_I + slope dT).
// Empty for fewer than three exposures.
std::optional<DarkCurrent> MeasureDarkCurrent(std::span<const SetStatistics* const> darks,
                                              const Quantity& gain_dn_per_e);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_DARK_CURRENT_H_
