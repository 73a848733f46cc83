// Fits w(x) to readings of disks, small sources and black spots, all at once.
#ifndef EYEBOX_FIT_SCATTER_FIT_SCATTER_H_
#define EYEBOX_FIT_SCATTER_FIT_SCATTER_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/base/parameter.h"
#include "fit/scatter/glare_series.h"
#include "optics/scatter/scatter_kernel.h"

namespace eyebox::fit {

inline constexpr int kGlareParameters = 7;
inline constexpr int kKernelParameters = 5;  // the first of them

// An instrument whose scatter is known, from a series on a flat display without optics of its own.
struct KnownScatter {
  optics::ScatterKernel kernel;
  // [5, 5] row-major: core radius, tail share, tail radius, tail exponent, pedestal share.
  std::array<double, kKernelParameters * kKernelParameters> covariance{};
};

struct ScatterFitOptions {
  optics::CoreShape core = optics::CoreShape::kGaussian;
  optics::TailShape tail = optics::TailShape::kMoffat;
  double reach_deg = 60;
  // Where the readings contradict that reach, a shorter one that they bear out is taken; through an
  // instrument it is held all the same.
  bool find_reach = false;
  bool pedestal = false;  // fitted, else held at 0
  // Held where given; luminances in the unit of the series.
  std::optional<double> core_radius_deg;
  std::optional<double> tail_radius_deg;
  std::optional<double> tail_exponent;
  std::optional<double> bright_luminance;
  std::optional<double> background_luminance;
  // Light passes the headset and then this instrument: their kernels convolve, and the fit is of
  // the headset's alone. Its uncertainty is carried into the covariance.
  std::optional<KnownScatter> instrument;

  // Errors: InvalidArgument naming the option.
  absl::Status Validate() const;
};

struct FittedGlareReading {
  GlareReading reading;
  double fitted = 0;
  double residual_sigmas = 0;  // (fitted - measured) / sigma
};

// A combination of parameters that the readings leave open: radii, exponent and bright luminance
// count by their logarithm, shares by their logit, the background in hundredths of the largest
// reading.
struct OpenCombination {
  std::array<double, kGlareParameters> direction{};  // unit length, 0 for held parameters
  double sigma = 0;                                  // standard uncertainty along it, in logarithms
  std::string words;
};

struct ScatterFit {
  optics::ScatterKernel kernel;
  double bright_luminance = 0;  // of disk, source or field; unit of the series
  double background_luminance = 0;
  // core_radius_deg, tail_share, tail_radius_deg, tail_exponent, pedestal_share, bright_luminance,
  // background_luminance; sigma 0 for what was held.
  std::array<Parameter, kGlareParameters> parameters;
  // [7, 7] row-major, that of the parameters. From the stated sigmas; scaled by the reduced
  // chi-square where that is larger than chance allows (3 standard deviations).
  std::array<double, kGlareParameters * kGlareParameters> covariance{};
  double reach_sigma_deg = 0;  // of the kernel's reach, 0 where it is held
  // Of the energy in tail and pedestal, for optics::CorrectionOptions.
  double glare_relative_sigma = 0;
  std::vector<FittedGlareReading> readings;
  double chi_square = 0;
  int degrees_of_freedom = 0;
  std::vector<OpenCombination> open;  // worst first; empty if all is determined
  std::string identifiability;        // one statement in words
  std::string termination;            // why the solver stopped, what ended at a bound

  KnownScatter AsInstrument() const;
};

// Errors: those of GlareSeries::Validate() and of the options; FailedPrecondition (fewer readings
// than free parameters, or no convergence: says what was tried).
absl::StatusOr<ScatterFit> FitScatter(const GlareSeries& series,
                                      const ScatterFitOptions& options = {});

// The same from a fit of nearly the same series: a fraction of the time.
absl::StatusOr<ScatterFit> FitScatterFrom(const ScatterFit& start, const GlareSeries& series,
                                          const ScatterFitOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_FIT_SCATTER_H_
