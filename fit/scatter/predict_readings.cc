#include "fit/scatter/predict_readings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/scatter/glare_model.h"

namespace eyebox::fit {
namespace {

constexpr double kStep = 1e-4;  // of a parameter, relative

GlareValues ValuesOf(const ScatterFit& fit) {
  GlareValues values{};
  for (int i = 0; i < kGlareParameters; ++i) values[i] = fit.parameters[i].value;
  return values;
}

// The three numbers of each reading whose uncertainty is stated.
using Figures = std::array<double, 3>;

std::vector<Figures> FiguresAt(const GlareModel& model, const GlareValues& values) {
  std::vector<Figures> figures;
  for (const GlareShares& share : model.Shares(KernelOf(values, model.options()))) {
    const double offset = share.background * values[kBackground];
    figures.push_back({share.bright, offset, share.bright * values[kBright] + offset});
  }
  return figures;
}

// Forward differences: a share may stand at 0, where there is nothing below it.
std::vector<std::array<Figures, kGlareParameters>> DerivativesAt(const GlareModel& model,
                                                                 const GlareValues& values,
                                                                 const std::vector<Figures>& base) {
  std::vector<std::array<Figures, kGlareParameters>> derivatives(base.size());
  for (int j = 0; j < kGlareParameters; ++j) {
    GlareValues moved = values;
    const double step = std::max(kStep * std::abs(values[j]), 1e-7);
    moved[j] += step;
    const std::vector<Figures> figures = FiguresAt(model, moved);
    for (size_t i = 0; i < base.size(); ++i) {
      for (size_t f = 0; f < base[i].size(); ++f) {
        derivatives[i][j][f] = (figures[i][f] - base[i][f]) / step;
      }
    }
  }
  return derivatives;
}

double SigmaOf(const ScatterFit& fit, const std::array<Figures, kGlareParameters>& derivatives,
               size_t figure) {
  double variance = 0;
  for (int i = 0; i < kGlareParameters; ++i) {
    for (int j = 0; j < kGlareParameters; ++j) {
      variance += derivatives[i][figure] * fit.covariance[i * kGlareParameters + j] *
                  derivatives[j][figure];
    }
  }
  return std::sqrt(std::max(variance, 0.0));
}

}  // namespace

absl::StatusOr<std::vector<PredictedReading>> PredictReadings(
    const ScatterFit& fit, const ScatterFitOptions& options, double field_radius_deg,
    std::span<const double> diameters_deg) {
  GlareSeries patches;
  patches.field_radius_deg = field_radius_deg;
  for (const double diameter : diameters_deg) {
    if (!(diameter > 0 && std::isfinite(diameter))) {
      return BadInput("diameter of a patch", absl::StrCat("is ", diameter, " deg"),
                      "give a diameter above 0");
    }
    const double shown = std::min(diameter, 2 * field_radius_deg);
    patches.readings.push_back({GlarePattern::kBrightDisk, shown, 0, 1, 1});
  }
  patches.readings.push_back({GlarePattern::kBrightDisk, 2 * field_radius_deg, 0, 1, 1});
  ScatterFitOptions of_fit = options;
  of_fit.reach_deg = fit.kernel.reach_deg;
  const GlareModel model(patches, of_fit);
  const GlareValues values = ValuesOf(fit);
  const std::vector<Figures> figures = FiguresAt(model, values);
  const auto derivatives = DerivativesAt(model, values, figures);
  std::vector<PredictedReading> predicted;
  for (size_t i = 0; i < figures.size(); ++i) {
    predicted.push_back({patches.readings[i].diameter_deg, figures[i][0],
                         SigmaOf(fit, derivatives[i], 0), figures[i][1],
                         SigmaOf(fit, derivatives[i], 1), figures[i][2],
                         SigmaOf(fit, derivatives[i], 2)});
  }
  return predicted;
}

}  // namespace eyebox::fit
