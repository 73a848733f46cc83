#include "fit/budget/budget_terms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"

namespace eyebox::fit {
namespace {

using optics::VarianceBudget;

constexpr std::pair<const char*, double VarianceBudget::*> kPixelTerms[] = {
    {"photon", &VarianceBudget::photon},
    {"read", &VarianceBudget::read},
    {"quantisation", &VarianceBudget::quantisation},
    {"dark", &VarianceBudget::dark},
    {"linearity", &VarianceBudget::linearity},
    {"scatter", &VarianceBudget::scatter}};

std::vector<double> Sigmas(const LevelSeries& series) {
  std::vector<double> sigmas;
  for (const LevelReading& reading : series.readings) sigmas.push_back(reading.luminance_sigma);
  return sigmas;
}

// The flat is one for all levels, so it is not in the readings' sigma: the others share what is.
void AddReductionTerms(const LevelSeries& series, std::span<const ReadingShares> shares,
                       std::vector<BudgetTerm>& terms) {
  const size_t count = series.readings.size();
  BudgetTerm drift{"drift", std::vector<double>(count), 0};
  std::vector<BudgetTerm> pixels;
  for (const auto& [name, member] : kPixelTerms) {
    pixels.push_back({name, std::vector<double>(count), 0});
  }
  for (size_t i = 0; i < count; ++i) {
    const LevelReading& reading = series.readings[i];
    double sum = 0;
    for (const auto& [name, member] : kPixelTerms) sum += shares[i].pixels.*member;
    // A black level that was set to 0 keeps its whole sigma, whatever its drift.
    drift.reading_sigma[i] =
        std::min(shares[i].drift_relative_sigma * reading.luminance, reading.luminance_sigma);
    const double own = reading.luminance_sigma * reading.luminance_sigma -
                       drift.reading_sigma[i] * drift.reading_sigma[i];
    for (size_t k = 0; k < pixels.size(); ++k) {
      const double share = sum > 0 ? shares[i].pixels.*kPixelTerms[k].second / sum : 0;
      pixels[k].reading_sigma[i] = std::sqrt(std::max(own * share, 0.0));
    }
  }
  terms.insert(terms.end(), pixels.begin(), pixels.end());
  terms.push_back(std::move(drift));
}

// Residuals of a variance of `factor` times the squared reciprocal weights.
BudgetTerm FromResiduals(const char* name, const ActivationProblem& problem, double factor) {
  BudgetTerm term{name, {}, 0};
  for (const WeightedReading& reading : problem.readings) {
    term.reading_sigma.push_back(std::sqrt(factor) / reading.root_weight);
  }
  return term;
}

bool IsNothing(const BudgetTerm& term) {
  return term.common_relative_sigma == 0 &&
         std::all_of(term.reading_sigma.begin(), term.reading_sigma.end(),
                     [](double sigma) { return sigma == 0; });
}

}  // namespace

absl::StatusOr<std::vector<BudgetTerm>> BudgetTerms(const ActivationFit& fit,
                                                    const LevelSeries& series,
                                                    std::span<const ReadingShares> shares) {
  const size_t count = fit.levels.size();
  if (series.readings.size() != count || (!shares.empty() && shares.size() != count)) {
    return BadInput(series.source,
                    absl::StrCat(series.readings.size(), " readings and ", shares.size(),
                                 " budgets of readings, for a fit of ", count),
                    "give those of the series that was fitted");
  }
  std::vector<BudgetTerm> terms;
  const ActivationProblem problem = ProblemOf(fit);
  const double reduced_chi_square = fit.chi_square / fit.degrees_of_freedom;
  if (fit.weighting != Weighting::kMeasuredSigma) {
    terms.push_back(FromResiduals("residual_scatter", problem, reduced_chi_square));
  } else {
    if (shares.empty()) {
      terms.push_back({"reading", Sigmas(series), 0});
    } else {
      AddReductionTerms(series, shares, terms);
    }
    if (reduced_chi_square > 1) {
      terms.push_back(FromResiduals("lack_of_fit", problem, reduced_chi_square - 1));
    }
  }
  const double flat = std::min(series.flat_relative_sigma, series.scale_relative_sigma);
  const double scale = series.scale_relative_sigma;
  const double apart_from_flat = std::sqrt((scale - flat) * (scale + flat));
  const double scatter = std::min(series.scatter_relative_sigma, apart_from_flat);
  terms.push_back({"flat", {}, flat});
  terms.push_back({"scatter_common", {}, scatter});
  terms.push_back(
      {"scale", {}, std::sqrt((apart_from_flat - scatter) * (apart_from_flat + scatter))});
  std::erase_if(terms, IsNothing);
  return terms;
}

}  // namespace eyebox::fit
