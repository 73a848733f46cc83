#include "fit/budget/monte_carlo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr size_t kLeastBatch = 10000;
constexpr double kMostFailures = 0.01;  // of the trials

absl::Status Validate(size_t quantities, const MonteCarloOptions& options) {
  const auto bad = [](const char* field, double value, const char* remedy) {
    return BadInput(absl::StrCat("Monte Carlo, ", field), absl::StrCat(value), remedy);
  };
  if (quantities == 0) return bad("quantities", 0, "ask for one at least");
  if (!(options.coverage > 0 && options.coverage < 1)) {
    return bad("coverage", options.coverage, "give a probability between 0 and 1");
  }
  if (options.digits < 1 || options.digits > 6) {
    return bad("digits", options.digits, "give 1 to 6");
  }
  if (!(options.tolerance_share > 0)) {
    return bad("tolerance_share", options.tolerance_share, "give a share above 0");
  }
  return absl::OkStatus();
}

// Mean and standard deviation of a stream (Welford 1962).
struct Running {
  double count = 0;
  double mean = 0;
  double squares = 0;

  void Add(double value) {
    count += 1;
    const double step = value - mean;
    mean += step / count;
    squares += step * (value - mean);
  }
  double Sigma() const { return count > 1 ? std::sqrt(squares / (count - 1)) : 0; }
  double SigmaOfMean() const { return Sigma() / std::sqrt(count); }
};

// Of one quantity over the batches so far: mean, sigma, low, high of each batch.
struct Progress {
  Running all;
  std::array<Running, 4> batches;
};

void AddBatch(std::vector<double>& values, double coverage, Progress& progress) {
  Running batch;
  for (const double value : values) {
    batch.Add(value);
    progress.all.Add(value);
  }
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  const auto inside = static_cast<size_t>(std::lround(coverage * count));
  const size_t below = (values.size() - inside) / 2;
  const double figures[] = {batch.mean, batch.Sigma(), values[below],
                            values[std::min(below + inside, values.size() - 1)]};
  for (size_t i = 0; i < progress.batches.size(); ++i) progress.batches[i].Add(figures[i]);
}

bool IsStable(const Progress& progress, const MonteCarloOptions& options) {
  const double sigma = progress.all.Sigma();
  if (sigma == 0) return true;
  const double tolerance = options.tolerance_share * NumericalTolerance(sigma, options.digits);
  return std::all_of(progress.batches.begin(), progress.batches.end(),
                     [&](const Running& figure) { return 2 * figure.SigmaOfMean() <= tolerance; });
}

}  // namespace

double DrawNormal(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.Uniform()));
  return radius * std::cos(2 * std::numbers::pi * random.Uniform());
}

double NumericalTolerance(double uncertainty, int digits) {
  double place = std::floor(std::log10(uncertainty)) - (digits - 1);
  // 9.96 with two digits is 10, not 99 tenths.
  if (std::round(uncertainty / std::pow(10, place)) >= std::pow(10, digits)) place += 1;
  return 0.5 * std::pow(10, place);
}

absl::StatusOr<MonteCarloResult> Propagate(size_t quantities, const Trial& trial,
                                           const MonteCarloOptions& options) {
  EYEBOX_RETURN_IF_ERROR(Validate(quantities, options));
  const size_t batch = std::max(
      kLeastBatch, static_cast<size_t>(std::ceil(100 / (1 - options.coverage) * (1 - 1e-12))));
  RandomStream random({options.seed});
  std::vector<Progress> progress(quantities);
  std::vector<std::vector<double>> values(quantities, std::vector<double>(batch));
  std::vector<double> one(quantities);
  MonteCarloResult result;
  while (!result.stable && (result.trials == 0 || result.trials + batch <= options.most_trials)) {
    for (size_t done = 0; done < batch;) {
      if (!trial(random, one)) {
        ++result.failed;
        if (static_cast<double>(result.failed) <=
            kMostFailures * static_cast<double>(result.trials + batch)) {
          continue;
        }
        return Rejected("Monte Carlo",
                        absl::StrCat(result.failed, " of ", result.trials + done + result.failed,
                                     " trials gave no result"),
                        "the uncertainties are too large for this model: measure more exactly");
      }
      for (size_t k = 0; k < quantities; ++k) values[k][done] = one[k];
      ++done;
    }
    result.trials += batch;
    for (size_t k = 0; k < quantities; ++k) AddBatch(values[k], options.coverage, progress[k]);
    // One batch says nothing about how far the next would differ.
    result.stable = result.trials > batch &&
                    std::all_of(progress.begin(), progress.end(),
                                [&](const Progress& p) { return IsStable(p, options); });
  }
  for (const Progress& p : progress) {
    result.figures.push_back({p.all.mean, p.all.Sigma(), p.batches[2].mean, p.batches[3].mean});
  }
  return result;
}

}  // namespace eyebox::fit
