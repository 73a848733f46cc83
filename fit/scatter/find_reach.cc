#include "fit/scatter/find_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "capture/base/status.h"
#include "fit/scatter/glare_covariance.h"

namespace eyebox::fit {
namespace {

constexpr double kStep = 1.15;     // from one reach tried to the next
constexpr int kMostSteps = 24;     // down to a thirtieth
constexpr int kRisesToEnd = 2;     // in a row: the least lies behind
constexpr double kMoreLikely = 9;  // of chi-square over what it is at its least: 3 sigma
constexpr int kMostRefinements = 12;
constexpr double kLeastMove = 1e-4;  // of the reach
constexpr double kRefinedFrom = 1.01;

// The least chi-square so far, with its neighbours on either side.
struct Bracket {
  ScatterFit below;
  ScatterFit least;
  ScatterFit above;
};

double Reach(const ScatterFit& fit) { return fit.kernel.reach_deg; }

// Half the second derivative of chi-square by the reach.
double Curvature(const Bracket& bracket) {
  const double down = Reach(bracket.least) - Reach(bracket.below);
  const double up = Reach(bracket.above) - Reach(bracket.least);
  const double fall = (bracket.below.chi_square - bracket.least.chi_square) / down;
  const double rise = (bracket.above.chi_square - bracket.least.chi_square) / up;
  return (fall + rise) / (down + up);
}

// Of the parabola through the three.
double Vertex(const Bracket& bracket) {
  const double down = Reach(bracket.least) - Reach(bracket.below);
  const double slope_below = (bracket.least.chi_square - bracket.below.chi_square) / down;
  const double curvature = Curvature(bracket);
  if (!(curvature > 0)) return Reach(bracket.least);
  return Reach(bracket.least) - (slope_below + curvature * down) / (2 * curvature);
}

// Where to look next: the vertex, or away from it into the wider side where it stands already.
double NextReach(const Bracket& bracket, double sigma_deg) {
  const double at = Reach(bracket.least);
  const double vertex = std::clamp(Vertex(bracket), 0.9 * Reach(bracket.below) + 0.1 * at,
                                   0.9 * Reach(bracket.above) + 0.1 * at);
  if (std::abs(vertex - at) > std::max(0.1 * sigma_deg, kLeastMove * at)) return vertex;
  const bool above = Reach(bracket.above) - at > at - Reach(bracket.below);
  return 0.5 * (at + Reach(above ? bracket.above : bracket.below));
}

void Narrow(Bracket& bracket, ScatterFit fit) {
  const bool above = Reach(fit) > Reach(bracket.least);
  ScatterFit& side = above ? bracket.above : bracket.below;
  if (fit.chi_square >= bracket.least.chi_square) {
    side = std::move(fit);
    return;
  }
  (above ? bracket.below : bracket.above) = std::exchange(bracket.least, std::move(fit));
}

// Until both neighbours are about as far as the reach is uncertain, where chi-square is a parabola.
absl::StatusOr<Bracket> Refined(Bracket bracket, const FitAtReach& fit_at) {
  for (int k = 0; k < kMostRefinements; ++k) {
    const double at = Reach(bracket.least);
    const double sigma = 1 / std::sqrt(std::max(Curvature(bracket), 1e-12));
    const double widest = std::max(Reach(bracket.above) - at, at - Reach(bracket.below));
    if (widest < std::max(4 * sigma, 4 * kLeastMove * at)) break;
    EYEBOX_ASSIGN_OR_RETURN(ScatterFit fit, fit_at(NextReach(bracket, sigma), bracket.least));
    Narrow(bracket, std::move(fit));
  }
  return bracket;
}

// The reach as one more parameter: chi-square rises by 1 at 1 standard deviation.
void AddReachSigma(const Bracket& bracket, ScatterFit& fit) {
  --fit.degrees_of_freedom;
  const double stated = 1 / std::sqrt(std::max(Curvature(bracket), 1e-12));
  fit.reach_sigma_deg = stated * std::sqrt(ExcessScatter(fit.chi_square, fit.degrees_of_freedom));
  const double apart = Reach(bracket.above) - Reach(bracket.below);
  std::array<double, kGlareParameters> moved{};
  for (int i = 0; i < kGlareParameters; ++i) {
    const double by_reach =
        (bracket.above.parameters[i].value - bracket.below.parameters[i].value) / apart;
    moved[i] = by_reach * fit.reach_sigma_deg;
  }
  AddToCovariance(moved, fit);
}

absl::StatusOr<ScatterFit> FitWithin(Bracket bracket, const FitAtReach& fit_at) {
  EYEBOX_ASSIGN_OR_RETURN(bracket, Refined(std::move(bracket), fit_at));
  const double vertex = std::clamp(Vertex(bracket), Reach(bracket.below), Reach(bracket.above));
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit fit, fit_at(vertex, bracket.least));
  AddReachSigma(bracket, fit);
  return fit;
}

}  // namespace

absl::StatusOr<ScatterFit> FindReach(const ScatterFit& widest, const FitAtReach& fit_at) {
  Bracket bracket{widest, widest, widest};
  ScatterFit last = widest;
  int rises = 0;
  for (int k = 0; k < kMostSteps && rises < kRisesToEnd; ++k) {
    auto fit = fit_at(Reach(last) / kStep, last);
    if (!fit.ok()) break;  // so short a reach explains nothing
    if (fit->chi_square < bracket.least.chi_square) {
      bracket.above = last;
      bracket.least = *fit;
      rises = 0;
    } else if (rises++ == 0) {
      bracket.below = *fit;
    }
    last = *std::move(fit);
  }
  const ScatterFit& least = bracket.least;
  const double chance = kMoreLikely * ExcessScatter(least.chi_square, least.degrees_of_freedom);
  const bool more_likely = least.chi_square < widest.chi_square - chance;
  if (!more_likely || rises == 0) return widest;
  return FitWithin(std::move(bracket), fit_at);
}

absl::StatusOr<ScatterFit> RefineReach(const ScatterFit& near, const FitAtReach& fit_at) {
  const double step = std::max(3 * near.reach_sigma_deg, (kRefinedFrom - 1) * Reach(near));
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit least, fit_at(Reach(near), near));
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit below, fit_at(Reach(near) - step, near));
  EYEBOX_ASSIGN_OR_RETURN(ScatterFit above, fit_at(Reach(near) + step, near));
  // Downhill to where it rises on both sides.
  for (int k = 0; k < kMostSteps; ++k) {
    const bool down = below.chi_square < least.chi_square;
    const bool up = !down && above.chi_square < least.chi_square;
    if (!down && !up) return FitWithin({below, least, above}, fit_at);
    ScatterFit& far = down ? above : below;
    ScatterFit& next = down ? below : above;
    far = std::exchange(least, next);
    EYEBOX_ASSIGN_OR_RETURN(next, fit_at(Reach(least) + (down ? -step : step), least));
  }
  least.termination += "; its reach was still moving and has no uncertainty";
  return least;
}

}  // namespace eyebox::fit
