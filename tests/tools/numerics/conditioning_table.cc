// Prints how the parameters of every fit with a covariance are entangled on a usual series: the
// condition number of the normal matrix, units taken out, and the digits that it costs at most.
#include <cmath>
#include <cstdio>
#include <span>
#include <string>

#include "capture/base/random.h"
#include "fit/activation/fit_activation.h"
#include "fit/base/conditioning.h"
#include "fit/color/fit_colour.h"
#include "fit/scatter/fit_scatter.h"
#include "tests/fit/color/synthetic_display.h"
#include "tests/fit/scatter/simulated_glare.h"

namespace eyebox::fit {
namespace {

void Print(const std::string& name, const absl::Status& status,
           std::span<const double> covariance) {
  if (!status.ok()) {
    std::printf("| %s | - | %s |\n", name.c_str(), std::string(status.message()).c_str());
    return;
  }
  const double condition = ConditionNumber(covariance);
  std::printf("| %s | %.3g | %.1f |\n", name.c_str(), condition, std::log10(condition));
}

LevelSeries SeriesOf(const Activation& display, int levels) {
  RandomStream random({17});
  LevelSeries series{{}, "cd/m2", 0, "simulated"};
  for (int i = 0; i < levels; ++i) {
    const double drive = i / (levels - 1.0);
    const double luminance = display.Luminance(drive);
    const double sigma = 0.003 * luminance;
    series.readings.push_back({drive, luminance + sigma * Gaussian(random), sigma});
  }
  return series;
}

void PrintActivations() {
  for (const int levels : {9, 17, 65}) {
    const LevelSeries series = SeriesOf({0.775, 420, 0.03, 2.2}, levels);
    for (const ActivationModel model :
         {ActivationModel::kPowerOffset, ActivationModel::kGammaWithCutoff,
          ActivationModel::kSrgbLike, ActivationModel::kMonotoneSpline}) {
      const auto fit = FitActivation(series, model, Weighting::kMeasuredSigma);
      Print("activation, " + std::string(NameOf(model)) + ", " + std::to_string(levels) + " levels",
            fit.status(), fit.ok() ? fit->covariance : std::vector<double>());
    }
  }
}

void PrintColours() {
  for (const ColourModelKind kind :
       {ColourModelKind::kAdditive, ColourModelKind::kDriveCrosstalk}) {
    const bool additive = kind == ColourModelKind::kAdditive;
    const ColourModel display = SyntheticDisplay(
        kind, additive ? std::vector<double>() : std::vector<double>{0.08, 0.02, 0.045});
    const auto fit = FitColour(Measure(display, GreysAndPrimaries(8), 0.003, 3), kind);
    Print(additive ? "colour, additive" : "colour, drive crosstalk", fit.status(),
          fit.ok() ? fit->covariance : std::vector<double>());
  }
}

void PrintScatters() {
  for (const double share : {0.01, 0.3}) {
    optics::ScatterKernel kernel;
    kernel.tail_share = share;
    const auto fit = FitScatter(SimulateGlare(kernel, {}, 1));
    const std::string name = share < 0.1 ? "scatter, tail 1 %" : "scatter, tail 30 %";
    if (fit.ok()) {
      Print(name, fit.status(), fit->covariance);
    } else {
      Print(name, fit.status(), {});
    }
  }
}

}  // namespace
}  // namespace eyebox::fit

int main() {
  std::printf("| fit | condition | digits |\n|---|---|---|\n");
  eyebox::fit::PrintActivations();
  eyebox::fit::PrintColours();
  eyebox::fit::PrintScatters();
  return 0;
}
