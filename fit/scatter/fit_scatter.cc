#include "fit/scatter/fit_scatter.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/scatter/find_reach.h"
#include "fit/scatter/glare_covariance.h"
#include "fit/scatter/glare_model.h"

namespace eyebox::fit {
namespace {

constexpr size_t kStarts = 5;

std::string UnitOf(int parameter, const GlareSeries& series) {
  if (parameter == kCoreRadius || parameter == kTailRadius) return "deg";
  return parameter == kBright || parameter == kBackground ? series.luminance_unit : "1";
}

std::vector<FittedGlareReading> Compare(const GlareSeries& series,
                                        const std::vector<double>& predicted) {
  std::vector<FittedGlareReading> fitted;
  for (size_t i = 0; i < predicted.size(); ++i) {
    const GlareReading& reading = series.readings[i];
    fitted.push_back(
        {reading, predicted[i], (predicted[i] - reading.luminance) / reading.luminance_sigma});
  }
  return fitted;
}

// From the grid of starting points unless one is given.
absl::StatusOr<ScatterFit> Fit(const GlareSeries& series, const ScatterFitOptions& options,
                               const ScatterFit* start) {
  EYEBOX_RETURN_IF_ERROR(series.Validate());
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  const GlareModel model(series, options);
  const int readings = static_cast<int>(series.readings.size());
  const int free = static_cast<int>(model.Free().size());
  if (readings < free) {
    return Rejected(series.source,
                    absl::StrCat(readings, " glare readings for ", free, " free parameters"),
                    "measure more disks or hold parameters that are known");
  }
  std::vector<GlareCoordinates> starts;
  if (start == nullptr) {
    starts = StartingPoints(model, kStarts);
  } else {
    GlareValues values{};
    for (int i = 0; i < kGlareParameters; ++i) values[i] = start->parameters[i].value;
    starts = {model.CoordinatesOf(values)};
  }
  EYEBOX_ASSIGN_OR_RETURN(GlareSolution solution, SolveGlare(model, starts));
  const GlareValues values = model.ValuesOf(solution.coordinates);
  ScatterFit fit;
  fit.kernel = KernelOf(values, options);
  fit.bright_luminance = values[kBright];
  fit.background_luminance = values[kBackground];
  fit.readings = Compare(series, model.Predict(values));
  fit.chi_square = solution.chi_square;
  fit.degrees_of_freedom = readings - free;
  fit.termination = std::move(solution.termination);
  GlareUncertainty uncertainty = MeasureUncertainty(
      model, solution.coordinates, ExcessScatter(fit.chi_square, fit.degrees_of_freedom));
  fit.covariance = uncertainty.covariance;
  fit.open = std::move(uncertainty.open);
  fit.identifiability = std::move(uncertainty.identifiability);
  for (int i = 0; i < kGlareParameters; ++i) {
    fit.parameters[i] = {kGlareNames[i], values[i], 0, UnitOf(i, series)};
  }
  StateSigmas(fit);
  return fit;
}

FitAtReach FitsOf(const GlareSeries& series, const ScatterFitOptions& options) {
  return [&series, &options](double reach_deg, const ScatterFit& start) {
    ScatterFitOptions held = options;
    held.reach_deg = reach_deg;
    return Fit(series, held, &start);
  };
}

// Through an instrument each fit takes long, and the far light is its own and the headset's.
bool MayFindReach(const ScatterFitOptions& options) {
  return options.find_reach && !options.instrument.has_value();
}

absl::StatusOr<ScatterFit> WithReach(ScatterFit fit, const GlareSeries& series,
                                     const ScatterFitOptions& options) {
  const bool contradicted = ExcessScatter(fit.chi_square, fit.degrees_of_freedom) > 1;
  if (!contradicted || !MayFindReach(options)) return fit;
  return FindReach(fit, FitsOf(series, options));
}

}  // namespace

absl::Status ScatterFitOptions::Validate() const {
  optics::ScatterKernel held{.core = core, .tail = tail, .reach_deg = reach_deg};
  held.core_radius_deg = core_radius_deg.value_or(held.core_radius_deg);
  held.tail_radius_deg = tail_radius_deg.value_or(held.tail_radius_deg);
  held.tail_exponent = tail_exponent.value_or(held.tail_exponent);
  EYEBOX_RETURN_IF_ERROR(held.Validate());
  if (bright_luminance.has_value() && !(*bright_luminance > 0 && *bright_luminance < HUGE_VAL)) {
    return BadInput("bright_luminance", absl::StrCat(*bright_luminance),
                    "give a luminance above 0, or leave it to the fit");
  }
  if (background_luminance.has_value() && !std::isfinite(*background_luminance)) {
    return BadInput("background_luminance", absl::StrCat(*background_luminance),
                    "give a finite luminance, or leave it to the fit");
  }
  return instrument.has_value() ? instrument->kernel.Validate() : absl::OkStatus();
}

KnownScatter ScatterFit::AsInstrument() const {
  KnownScatter known{kernel, {}};
  for (int i = 0; i < kKernelParameters; ++i) {
    for (int j = 0; j < kKernelParameters; ++j) {
      known.covariance[i * kKernelParameters + j] = covariance[i * kGlareParameters + j];
    }
  }
  return known;
}

absl::StatusOr<ScatterFit> FitScatter(const GlareSeries& series, const ScatterFitOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit fit, Fit(series, options, nullptr));
  return WithReach(std::move(fit), series, options);
}

absl::StatusOr<ScatterFit> FitScatterFrom(const ScatterFit& start, const GlareSeries& series,
                                          const ScatterFitOptions& options) {
  if (start.reach_sigma_deg > 0 && MayFindReach(options)) {
    return RefineReach(start, FitsOf(series, options));
  }
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit fit, Fit(series, options, &start));
  return WithReach(std::move(fit), series, options);
}

}  // namespace eyebox::fit
