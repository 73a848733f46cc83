// EMVA 1288 release 4.0, linear camera model: from the statistics of a series to the figures of a
// data sheet. Names in comments are the standard's symbols.
//
// mu_y = mu_y.dark + K eta mu_p,  sigma_y^2 = K^2 sigma_d^2 + sigma_q^2 + K (mu_y - mu_y.dark)
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_EVALUATE_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_EVALUATE_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/sensor/emva1288/line_fit.h"
#include "optics/sensor/emva1288/set_statistics.h"

namespace eyebox::optics {

inline constexpr char kEmva1288Release[] = "EMVA 1288 release 4.0 linear";

struct Emva1288Options {
  bool photons_known = true;     // irradiation is photons per pixel; else proportional to them
  double gain_fraction = 0.7;    // of saturation: upper end of the fits of K and R
  double linearity_from = 0.05;  // of saturation
  double linearity_to = 0.95;
  // Sets of exactly two images make the temporal series and the others serve the spatial figures,
  // where both kinds exist; false: every set serves both.
  bool pairs_are_temporal = true;
};

// One step of the series, its dark subtracted.
struct PhotonTransferStep {
  double exposure_s = 0;
  double irradiation = 0;
  int group = 0;         // see SetCondition
  double signal_dn = 0;  // mu_y - mu_y.dark
  double signal_sigma_dn = 0;
  double dark_mean_dn = 0;         // mu_y.dark
  double variance_dn2 = 0;         // sigma_y^2
  double excess_variance_dn2 = 0;  // sigma_y^2 - sigma_y.dark^2
  double variance_sigma_dn2 = 0;
  double saturated_share = 0;
  double linearity_deviation = 0;  // relative; NaN outside the range of the linearity fit
};

struct LinearityError {
  double mean_absolute = 0;  // LE of release 4.0, a ratio
  double minimum = 0;        // LE_min of release 3.1
  double maximum = 0;        // LE_max
  double sigma = 0;          // of one deviation, from temporal noise
  int steps = 0;
};

struct DarkCurrent {
  Quantity from_mean_e_s;                     // mu_I.mean
  std::optional<Quantity> from_variance_e_s;  // mu_I.var, where the variance grows
  // Where the darks were taken at temperatures at least 2 K apart: mu_I.mean is that at
  // `temperature_degC`, their mean.
  std::optional<Quantity> per_kelvin_e_s_K;
  std::optional<double> temperature_degC;
};

struct Emva1288Result {
  std::string release = kEmva1288Release;
  Quantity gain_dn_per_e;                      // K
  Quantity responsivity_dn;                    // R, DN per photon or per unit of irradiation
  std::optional<Quantity> quantum_efficiency;  // eta
  Quantity dark_noise_dn;                      // sigma_y.dark
  Quantity dark_noise_e;                       // sigma_d, without quantisation
  bool dark_noise_is_quantisation = false;     // sigma_y.dark^2 < 0.24 DN^2: held there
  Quantity dark_mean_dn;                       // mu_y.dark at the shortest exposure
  bool saturation_reached = false;             // else the highest step stands in, a lower bound
  Quantity saturation_irradiation;             // mu_p.sat: where sigma_y^2 is largest
  Quantity saturation_e;                       // mu_e.sat = eta mu_p.sat
  std::optional<Quantity> plateau_e;           // (mean of the saturated image - dark) / K
  Quantity threshold_e;                        // mu_e.min, where the SNR is 1
  std::optional<Quantity> threshold_photons;   // mu_p.min
  Quantity dynamic_range;                      // DR = mu_p.sat / mu_p.min
  Quantity snr_max;                            // sqrt(mu_e.sat)
  Quantity dsnu_e;                             // DSNU1288, of the unfiltered dark
  Quantity prnu;                               // PRNU1288, a ratio, high-passed (section 8.1)
  Quantity prnu_unfiltered;                    // release 3.0: holds uneven light as well
  std::optional<LinearityError> linearity;     // for three or more steps in its range
  std::optional<DarkCurrent> dark_current;     // for three or more dark exposures
  std::vector<PhotonTransferStep> steps;       // by rising irradiation
  std::vector<std::string> warnings;

  double DynamicRangeDb() const;
  double SnrMaxDb() const;
};

// Every bright set needs a dark of its exposure. The linearity error is that of the group with most
// steps in its range.
// Errors: InvalidArgument (no dark of an exposure: named), FailedPrecondition (fewer than three
// bright steps, K not above 0, no bright set unsaturated near half of saturation).
absl::StatusOr<Emva1288Result> EvaluateEmva1288(std::span<const SetStatistics> sets,
                                                const Emva1288Options& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_EVALUATE_H_
