#include "fit/budget/luminance_budget.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "fit/base/conditioning.h"
#include "fit/cube/goal.h"

namespace eyebox::fit {
namespace {

// d(drive, departure, luminance) / d(parameters) at one point, [parameters] each.
struct Sensitivities {
  std::vector<double> drive, departure, luminance;
};

// The drive solves L(v) = x (L0 + L1), so dv = (x d(L0 + L1) - dL at that v) / (dL/dv).
Sensitivities SensitivitiesAt(const ActivationFit& fit, double x, double drive) {
  const Activation& a = fit.activation;
  Sensitivities by;
  by.luminance = ParameterGradient(fit.model, a, drive);
  const double by_drive = a.luminance_range * a.Slope(drive);
  const double wanted = WantedLuminance(a, x);
  for (size_t k = 0; k < by.luminance.size(); ++k) {
    const bool adds_to_white = k < 2;  // L0 and L1
    // At white the wanted luminance is the fitted one, whatever the parameters.
    const double excess = x == 1 ? 0 : (adds_to_white ? x : 0) - by.luminance[k];
    by.drive.push_back(excess / by_drive);
    by.departure.push_back(excess / wanted);
  }
  return by;
}

// What a term adds to the variance of a quantity.
double VarianceOf(const BudgetTerm& term, const ActivationFit& fit,
                  const std::vector<double>& by_parameter) {
  // A common factor moves L0 and L1 alike, and nothing else.
  const Activation& a = fit.activation;
  const double common = term.common_relative_sigma * (by_parameter[0] * a.minimum_luminance +
                                                      by_parameter[1] * a.luminance_range);
  double variance = common * common;
  const size_t readings = term.reading_sigma.size();
  for (size_t j = 0; j < readings; ++j) {
    double by_reading = 0;
    for (size_t k = 0; k < by_parameter.size(); ++k) {
      by_reading += by_parameter[k] * fit.response[readings * k + j];
    }
    variance += by_reading * by_reading * term.reading_sigma[j] * term.reading_sigma[j];
  }
  return variance;
}

BudgetPoint PointAt(const ActivationFit& fit, std::span<const BudgetTerm> terms, double x) {
  BudgetPoint point;
  point.x = x;
  point.drive = x == 1 ? 1 : DriveForLuminance(fit.activation, WantedLuminance(fit.activation, x));
  point.luminance = fit.activation.Luminance(point.drive);
  const Sensitivities by = SensitivitiesAt(fit, x, point.drive);
  TermShare sum;
  for (const BudgetTerm& term : terms) {
    const TermShare share = {term.name, VarianceOf(term, fit, by.drive),
                             VarianceOf(term, fit, by.departure),
                             VarianceOf(term, fit, by.luminance)};
    sum.drive += share.drive;
    sum.departure += share.departure;
    sum.luminance += share.luminance;
    point.terms.push_back(share);
  }
  const auto part = [](double of, double whole) { return whole > 0 ? of / whole : 0; };
  for (TermShare& share : point.terms) {
    share.drive = part(share.drive, sum.drive);
    share.departure = part(share.departure, sum.departure);
    share.luminance = part(share.luminance, sum.luminance);
  }
  std::stable_sort(point.terms.begin(), point.terms.end(),
                   [](const auto& a, const auto& b) { return a.luminance > b.luminance; });
  point.drive_sigma = std::sqrt(sum.drive);
  point.departure_sigma = std::sqrt(sum.departure);
  point.luminance_sigma = std::sqrt(sum.luminance);
  return point;
}

}  // namespace

std::vector<double> UsualBudgetPoints() { return {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8, 1}; }

absl::StatusOr<LuminanceBudget> MakeLuminanceBudget(const ActivationFit& fit,
                                                    std::span<const BudgetTerm> terms,
                                                    std::span<const double> x) {
  for (const BudgetTerm& term : terms) {
    if (term.reading_sigma.empty() || term.reading_sigma.size() == fit.levels.size()) continue;
    return BadInput(
        absl::StrCat("budget, term ", term.name),
        absl::StrCat(term.reading_sigma.size(), " readings for a fit of ", fit.levels.size()),
        "give one sigma for each reading of the fit");
  }
  LuminanceBudget budget;
  budget.condition_number = ConditionNumber(fit.covariance);
  const double minimum = CutoffOf(fit.activation);
  for (const double value : x) {
    if (!(value > 0 && value <= 1)) {
      return BadInput("budget", absl::StrCat("x is ", value), "give fractions of white above 0");
    }
    if (value > minimum * (1 + 1e-9)) budget.points.push_back(PointAt(fit, terms, value));
  }
  if (budget.points.empty()) {
    return Rejected("budget",
                    absl::StrCat("the display shows its minimum up to ", minimum, " of white"),
                    "ask for larger fractions of white");
  }
  return budget;
}

}  // namespace eyebox::fit
