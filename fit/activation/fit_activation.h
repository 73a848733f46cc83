// Fits the activation of one place to its series of levels.
#ifndef EYEBOX_FIT_ACTIVATION_FIT_ACTIVATION_H_
#define EYEBOX_FIT_ACTIVATION_FIT_ACTIVATION_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/activation/level_series.h"
#include "fit/base/activation.h"
#include "fit/base/parameter.h"

namespace eyebox::fit {

enum class ActivationModel {
  kPowerOffset,      // L = L0 + L1 v^gamma, v0 held at 0
  kGammaWithCutoff,  // L = L0 + L1 max((v - v0) / (1 - v0), 0)^gamma, v0 >= 0
  kSrgbLike,         // a straight toe, then a power, C1 between them; v0 held at 0 (ToePower)
  kMonotoneSpline,  // gamma with cutoff of a warped drive, see MonotoneWarp; the number of knots by
                    // cross-validation
};
// "power_offset", "gamma_with_cutoff", "srgb_like", "monotone_spline".
std::string_view NameOf(ActivationModel model);

enum class Weighting {
  kMeasuredSigma,  // 1 / sigma^2 of each reading
  kRelative,       // 1 / max(L, floor)^2: equal relative errors; floor = kRelativeFloor of white
  kUnweighted,     // as usually published; for comparison
};
std::string_view NameOf(Weighting weighting);  // "measured_sigma", "relative", "unweighted"

struct FittedLevel {
  LevelReading reading;
  double fitted = 0;             // luminance of the fit
  double relative_residual = 0;  // (measured - fitted) / max(fitted, floor)
};

struct ActivationFit {
  Activation activation;
  ActivationModel model = ActivationModel::kGammaWithCutoff;
  Weighting weighting = Weighting::kRelative;
  // minimum_luminance (L0), luminance_range (L1), cutoff_drive (v0), gamma: always these four
  // first; then toe_drive of srgb_like, or spline_log_slope_1, ... of monotone_spline: ln of the
  // slope of the warp at each knot but the last over the slope there.
  std::vector<Parameter> parameters;
  // [parameters, parameters] row-major, in their order; zero rows for a parameter that was held.
  // With measured sigmas these are absolute, unless reduced chi-square is above 1: then scaled by
  // it. With other weightings the scale is estimated from the residuals. The series' scale
  // uncertainty is added to L0 and L1. A parameter that ended at its bound (L0 = 0, v0 = 0; the
  // termination says so) keeps the sigma it would have if the bound were not there.
  std::vector<double> covariance;
  // [parameters, readings] row-major: how each follows the luminance of each reading, to first
  // order; zeros for a parameter that was held.
  std::vector<double> response;
  std::vector<FittedLevel> levels;
  double rms_relative = 0;  // over all readings, of (fitted - measured) / max(measured, floor)
  double leave_one_out_rms_relative = 0;  // interior levels, each predicted without any
                                          // reading at its drive; of max(measured, floor)
  double chi_square = 0;                  // weighted sum of squares
  int degrees_of_freedom = 0;
  double aicc = 0;          // to compare models under one weighting; infinite for too few readings
  std::string termination;  // why the solver stopped, in words
};

// Errors: those of LevelSeries::Validate(); InvalidArgument (kMeasuredSigma without sigmas);
// FailedPrecondition (fewer different drives than parameters + 1, for a spline 8; gamma at its
// limits of 0.3 and 8, parameters that the readings do not determine, no convergence: says what was
// tried).
absl::StatusOr<ActivationFit> FitActivation(const LevelSeries& series, ActivationModel model,
                                            Weighting weighting);

// Standard uncertainty of the fitted L at `drive`, from the covariance of the parameters: the band
// of a prediction, without the noise of a new reading. Finite for every drive.
double LuminanceSigma(const ActivationFit& fit, double drive);

// The leave-one-out error that the scatter of the readings alone would leave, were the model exact:
// their stated sigmas, else that of the residuals about the fit (sqrt(chi_square /
// degrees_of_freedom)). Beside leave_one_out_rms_relative it says how much of that error a better
// model could take away. To first order; 0 for kUnweighted, whose weights tell no scatter.
double LeftOutByScatter(const ActivationFit& fit);

struct ActivationChoice {
  ActivationFit best;
  std::vector<ActivationFit> tried;  // all models, the best one included
  std::string reason;                // why the best one was taken, in words
};

struct ActivationOptions {
  std::optional<ActivationModel> model;  // all are tried unless given
  std::optional<Weighting> weighting;    // measured sigmas where the series has them, else relative
};

// The model with the smallest leave-one-out error; the simpler one where that is not clearly worse.
// Errors: those of FitActivation.
absl::StatusOr<ActivationChoice> ChooseActivation(const LevelSeries& series,
                                                  const ActivationOptions& options = {});

// One line of the table of all models under all weightings.
struct ComparedActivation {
  ActivationModel model = ActivationModel::kPowerOffset;
  Weighting weighting = Weighting::kRelative;
  absl::StatusOr<ActivationFit> fit;
};

// Every model under every weighting that the series allows, for comparison: AICc compares within
// one weighting only.
std::vector<ComparedActivation> CompareActivations(const LevelSeries& series);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_ACTIVATION_FIT_ACTIVATION_H_
