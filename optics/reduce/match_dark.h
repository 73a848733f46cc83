// The dark that belongs to a light: of its exposure and gain, and of its temperature where the
// frames tell it.
//
// Dark current grows with temperature, mu_I(T) = mu_I(T0) 2^((T - T0) / T_d) (EMVA 1288 release
// 4.0, "temperature dependence of the dark current"). What a dark of another temperature may be
// off by is bounded with T_d = 5 K, which is steeper than silicon sensors are, and an upper bound
// of the dark current from the darks themselves.
#ifndef EYEBOX_OPTICS_REDUCE_MATCH_DARK_H_
#define EYEBOX_OPTICS_REDUCE_MATCH_DARK_H_

#include <memory>
#include <optional>

#include "absl/status/statusor.h"
#include "optics/reduce/calibration.h"

namespace eyebox::optics {

// Fills dark_current_dn of all darks: the growth of their mean count, over the pixels that are not
// defective, from the shortest exposure to the longest. Where that says nothing (one exposure, or
// counts clipped at 0 DN) it stays unknown.
void StateDarkCurrents(Calibration& calibration);

// DN by which the mean of a dark may differ from that of a light at `temperature_deg_c`; 0 where
// one of the two tells no temperature. An unknown dark current is bounded by the noise in the dark,
// whose variance is at least K times it.
double ThermalErrorDn(const DarkFrame& dark, double temperature_deg_c, const NoiseModel& noise);

// Where darks of several temperatures were recorded: the nearest, or the weighted mean of two that
// enclose the light's, whichever may be off by less. The variance of the dark counts that error
// once it is above a twentieth of the temporal dark noise of a frame; its history says so. Where a
// dark of the setting tells no temperature the first one is taken, as from a camera that never
// does. Errors: those of FindDark(); FailedPrecondition (the error may exceed the temporal dark
// noise: names both temperatures. Or the light tells none, and the darks differ by that much).
absl::StatusOr<std::shared_ptr<const DarkFrame>> DarkFor(const Calibration& calibration,
                                                         const Setting& setting,
                                                         std::optional<double> temperature_deg_c);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_MATCH_DARK_H_
