// Propagation of distributions by random trials, as many as the figures need (JCGM 101:2008, 7.9).
#ifndef EYEBOX_FIT_BUDGET_MONTE_CARLO_H_
#define EYEBOX_FIT_BUDGET_MONTE_CARLO_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/random.h"

namespace eyebox::fit {

// Standard normal, by Box and Muller (1958).
double DrawNormal(RandomStream& random);

// JCGM 101, 7.9.2: half a unit of the last of `digits` significant digits of `uncertainty` (above
// 0); what a figure stated with that many digits may be off.
double NumericalTolerance(double uncertainty, int digits);

struct MonteCarloOptions {
  double coverage = 0.95;
  int digits = 1;  // significant ones of a standard uncertainty
  // Trials go on until the figures hold within this share of the numerical tolerance: 1 for their
  // own sake, 1/5 to check something else by them (JCGM 101, 8.2).
  double tolerance_share = 1;
  size_t most_trials = 1000000;
  uint64_t seed = 1;
};

// Of one quantity.
struct MonteCarloFigure {
  double mean = 0;
  double sigma = 0;
  double low = 0;   // ends of the probabilistically symmetric coverage interval
  double high = 0;  // (JCGM 101, 7.7)
};

struct MonteCarloResult {
  std::vector<MonteCarloFigure> figures;  // [quantities]
  size_t trials = 0;
  size_t failed = 0;    // that gave no result; not among `trials`
  bool stable = false;  // else most_trials came first
};

// Draws the inputs of one trial and writes its quantities. False: the trial has no result.
using Trial = std::function<bool(RandomStream& random, std::span<double> quantities)>;

// Batches of max(10^4, 100 / (1 - coverage)) trials until twice the standard deviation of mean,
// sigma and both ends of the mean over batches is within the tolerance for every quantity.
// The same seed gives the same figures. Memory: the trials of one batch.
// Errors: InvalidArgument (options out of range, no quantity), FailedPrecondition (more than one
// trial in a hundred has no result).
absl::StatusOr<MonteCarloResult> Propagate(size_t quantities, const Trial& trial,
                                           const MonteCarloOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BUDGET_MONTE_CARLO_H_
