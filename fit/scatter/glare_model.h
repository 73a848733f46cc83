// The forward model behind a scatter fit: readings from parameters.
#ifndef EYEBOX_FIT_SCATTER_GLARE_MODEL_H_
#define EYEBOX_FIT_SCATTER_GLARE_MODEL_H_

#include <array>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "fit/scatter/fit_scatter.h"
#include "fit/scatter/light_table.h"

namespace eyebox::fit {

inline constexpr std::array<const char*, kGlareParameters> kGlareNames = {
    "core_radius_deg", "tail_share",       "tail_radius_deg",     "tail_exponent",
    "pedestal_share",  "bright_luminance", "background_luminance"};
enum GlareParameter {
  kCoreRadius,
  kTailShare,
  kTailRadius,
  kTailExponent,
  kPedestalShare,
  kBright,
  kBackground
};

// As the solver sees them, without bounds of their own: logarithms of radii, exponent and bright
// luminance; logits of the tail's share of all energy and of the pedestal's share of the rest;
// background in hundredths of the largest reading.
using GlareCoordinates = std::array<double, kGlareParameters>;
// In their own units, named by kGlareNames.
using GlareValues = std::array<double, kGlareParameters>;

optics::ScatterKernel KernelOf(const GlareValues& values, const ScatterFitOptions& options);

// What of a reading is of the bright luminance and what of the background; linear in both.
struct GlareShares {
  double bright = 0;
  double background = 0;
};

struct GlareEvaluation {
  std::vector<double> residuals;  // (predicted - measured) / sigma, [readings]
  std::vector<double> jacobian;   // their derivatives by the coordinates, [readings, 7] row-major
};

class GlareModel {
 public:
  // Both must be valid. Tabulates what the instrument alone does.
  GlareModel(const GlareSeries& series, const ScatterFitOptions& options);

  const GlareSeries& series() const { return series_; }
  const ScatterFitOptions& options() const { return options_; }
  std::vector<int> Free() const;  // indices of parameters that are not held, ascending

  GlareValues ValuesOf(const GlareCoordinates& coordinates) const;
  GlareCoordinates CoordinatesOf(const GlareValues& values) const;
  // Derivatives of values by coordinates, [value][coordinate].
  std::array<GlareCoordinates, kGlareParameters> ValueDerivatives(
      const GlareCoordinates& coordinates) const;

  std::vector<GlareShares> Shares(const optics::ScatterKernel& kernel) const;
  std::vector<double> Predict(const GlareValues& values) const;
  GlareEvaluation Evaluate(const GlareCoordinates& coordinates) const;
  std::vector<double> Residuals(const GlareCoordinates& coordinates) const;

 private:
  GlareSeries series_;
  ScatterFitOptions options_;
  double luminance_unit_;
  LightTable table_;
};

struct GlareSolution {
  GlareCoordinates coordinates{};
  double chi_square = 0;
  std::string termination;
};

// The best optimum reached from these starting points.
// Errors: FailedPrecondition (converged from none of them).
absl::StatusOr<GlareSolution> SolveGlare(const GlareModel& model,
                                         const std::vector<GlareCoordinates>& starts);

// Starting points, best first: coarse kernels, each with the luminances that suit it best.
std::vector<GlareCoordinates> StartingPoints(const GlareModel& model, size_t most);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_GLARE_MODEL_H_
