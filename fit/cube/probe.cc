#include "fit/cube/probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "fit/cube/block_compression.h"
#include "fit/cube/sampling.h"
#include "optics/render/srgb.h"

namespace eyebox::fit {
namespace {

constexpr std::array<double, 3> kLuminanceShares = {0.2126, 0.7152, 0.0722};
constexpr double kLeastExponent = 0.4;
constexpr double kLargestExponent = 2.5;
constexpr double kNamedFrom = 0.95;
constexpr double kLargestDeviate = 3.09;  // one-sided 1 in 1000
constexpr double kUsualExponent = 1.1;    // 2.4 / 2.2, say, to plan by

Cube3d ImportedAsSrgb(Cube3d cube) {
  for (auto& entry : cube.entries) {
    for (double& value : entry) value = optics::SrgbToLinear(std::clamp(value, 0.0, 1.0));
  }
  return cube;
}

// The smallest value of `cost` between the limits: a grid, then golden section around its best.
double BestExponent(const std::function<double(double)>& cost) {
  constexpr int kGrid = 24;
  constexpr double kGolden = 0.6180339887498949;
  const double ratio = std::pow(kLargestExponent / kLeastExponent, 1.0 / kGrid);
  double best = kLeastExponent;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kGrid; ++i) {
    const double exponent = kLeastExponent * std::pow(ratio, i);
    const double value = cost(exponent);
    if (value >= smallest) continue;
    smallest = value;
    best = exponent;
  }
  double low = best / ratio;
  double high = best * ratio;
  for (int i = 0; i < 30; ++i) {
    const double left = high - kGolden * (high - low);
    const double right = low + kGolden * (high - low);
    if (cost(left) < cost(right)) {
      high = right;
    } else {
      low = left;
    }
  }
  return (low + high) / 2;
}

// What a free exponent costs: the share of its prior, even in log p, that the readings leave
// (Laplace). Without it, any wrong size would pass for an exponent near 1.
double LogOccam(double best, const std::function<double(double)>& cost) {
  constexpr double kStep = 1e-3;
  const double curvature =
      (cost(best + kStep) - 2 * cost(best) + cost(best - kStep)) / (kStep * kStep);
  if (!(curvature > 0)) return 0;
  const double width = std::sqrt(2 / curvature) * std::sqrt(2 * std::numbers::pi) / best;
  return std::min(std::log(width / std::log(kLargestExponent / kLeastExponent)), 0.0);
}

struct ScaleFit {
  double scale = 0;
  double chi_square = 0;
};

ScaleFit FitScale(std::span<const ProbeReading> readings, std::span<const double> expected) {
  double products = 0;
  double squares = 0;
  double all = 0;
  for (size_t i = 0; i < readings.size(); ++i) {
    const double weight = 1 / (readings[i].sigma * readings[i].sigma);
    products += weight * readings[i].luminance * expected[i];
    squares += weight * expected[i] * expected[i];
    all += weight * readings[i].luminance * readings[i].luminance;
  }
  if (!(squares > 0)) return {0, all};
  double chi_square = 0;
  for (size_t i = 0; i < readings.size(); ++i) {
    const double residual = readings[i].luminance - products / squares * expected[i];
    chi_square += std::pow(residual / readings[i].sigma, 2);
  }
  return {products / squares, chi_square};
}

ProbeLikelihood FitHypothesis(const ProbeHypothesis& hypothesis, const Activation& activation,
                              std::span<const ProbeReading> readings) {
  const auto fit = [&](double exponent) {
    std::vector<double> expected;
    for (const ProbeReading& reading : readings) {
      expected.push_back(hypothesis.Luminance(activation, reading.u, exponent));
    }
    return FitScale(readings, expected);
  };
  ProbeLikelihood likelihood;
  likelihood.free_parameters = hypothesis.has_exponent() ? 2 : 1;
  if (hypothesis.has_exponent()) {
    const auto cost = [&](double p) { return fit(p).chi_square; };
    likelihood.exponent = BestExponent(cost);
    likelihood.log_occam = LogOccam(likelihood.exponent, cost);
  }
  const ScaleFit best = fit(likelihood.exponent);
  likelihood.scale = best.scale;
  likelihood.chi_square = best.chi_square;
  return likelihood;
}

// The larger the readings' chi-square for its degrees of freedom, the larger: a standard normal
// deviate (Wilson and Hilferty).
double DeviateOf(double chi_square, int degrees_of_freedom) {
  const double spread = 2.0 / (9 * degrees_of_freedom);
  return (std::cbrt(chi_square / degrees_of_freedom) - (1 - spread)) / std::sqrt(spread);
}

void Decide(std::span<const ProbeHypothesis> hypotheses, size_t readings, ProbeVerdict& verdict) {
  std::vector<size_t> order(hypotheses.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](size_t a, size_t b) {
    return verdict.likelihoods[a].log_likelihood_ratio >
           verdict.likelihoods[b].log_likelihood_ratio;
  });
  const ProbeLikelihood& best = verdict.likelihoods[order[0]];
  const std::string& name = hypotheses[order[0]].name();
  const std::string& next = hypotheses[order[1]].name();
  const int freedom = static_cast<int>(readings) - best.free_parameters;
  const std::string figures =
      absl::StrFormat("chi-square %.1f for %d degrees of freedom", best.chi_square, freedom);
  if (DeviateOf(best.chi_square, freedom) > kLargestDeviate) {
    verdict.verdict = "none of these";
    verdict.reason = absl::StrCat("even the likeliest, ", name, ", leaves ", figures,
                                  ": the display, the instrument or the stated noise is another");
    return;
  }
  if (best.probability < kNamedFrom) {
    verdict.verdict = "undecided";
    verdict.reason = absl::StrFormat(
        "%s (%.1f %%) and %s (%.1f %%) cannot be told apart: read the "
        "patches more often or with less noise",
        name, 100 * best.probability, next, 100 * verdict.likelihoods[order[1]].probability);
    return;
  }
  verdict.verdict = name;
  verdict.reason = absl::StrFormat("probability %.4f %%, %s; next is %s, exp(%.1f) less likely",
                                   100 * best.probability, figures, next,
                                   -verdict.likelihoods[order[1]].log_likelihood_ratio);
}

}  // namespace

ProbeHypothesis::ProbeHypothesis(std::string name, TableTarget target, const Cube3d& held,
                                 int read_size, bool has_exponent)
    : name_(std::move(name)),
      target_(target),
      table_{held.size, held.entries},
      read_size_(read_size),
      has_exponent_(has_exponent) {}

std::array<double, 3> ProbeHypothesis::Drive(double u) const {
  double position = PositionOf(target_, table_.size, u);
  if (read_size_ != table_.size) {
    // Texture coordinates put entry i of n at (i + 1/2) / n, with n as the shader believes it is.
    const double believed = PositionOf(target_, read_size_, u);
    position = (believed + 0.5) / read_size_ * table_.size - 0.5;
  }
  optics::Rgb drive = optics::SampleTrilinear(table_, {position, position, position});
  for (double& value : drive) value = DriveOfEntry(target_, value);
  return drive;
}

double ProbeHypothesis::Luminance(const Activation& activation, double u, double exponent) const {
  const std::array<double, 3> drive = Drive(u);
  double luminance = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double shown = exponent == 1 ? drive[c] : std::pow(drive[c], exponent);
    luminance += kLuminanceShares[c] * activation.Luminance(shown);
  }
  return luminance;
}

double ProbeHypothesis::OutputSigma(const Activation& activation, double u) const {
  constexpr double kHalfStep = 0.5 / 255;
  const double drive = Drive(u)[1];
  const double step =
      activation.Luminance(drive + kHalfStep) - activation.Luminance(drive - kHalfStep);
  return step / std::sqrt(12.0);
}

absl::StatusOr<std::vector<ProbeHypothesis>> ProbeHypotheses(TableTarget target,
                                                             const Cube3d& table) {
  if (target == TableTarget::kPtb) {
    return BadInput("probe", "a table for ptb passes no renderer",
                    "give hdrp, pps or resolve; verify a ptb table by reading a few grey levels");
  }
  std::vector<ProbeHypothesis> hypotheses;
  const auto add = [&](std::string name, const Cube3d& held, int read_size, bool has_exponent) {
    hypotheses.emplace_back(std::move(name), target, held, read_size, has_exponent);
  };
  add("right table", table, table.size, false);
  if (target == TableTarget::kHdrp) {
    for (int size : {16, 32, 64}) {
      if (size != table.size) add(absl::StrCat("grading size ", size), table, size, false);
    }
  }
  add("sRGB import", ImportedAsSrgb(table), table.size, false);
  add("block compression", CompressBlocks(table), table.size, false);
  add("colour-managed desktop", table, table.size, true);
  return hypotheses;
}

double ProbeSeparation(const ProbeHypothesis& truth, const ProbeHypothesis& model,
                       const Activation& activation, std::span<const double> patches,
                       double noise_relative) {
  const double exponent = truth.has_exponent() ? kUsualExponent : 1;
  std::vector<ProbeReading> readings;
  for (double u : patches) {
    const double luminance = truth.Luminance(activation, u, exponent);
    readings.push_back(
        {u, luminance, std::hypot(noise_relative * luminance, truth.OutputSigma(activation, u))});
  }
  return FitHypothesis(model, activation, readings).chi_square;
}

std::vector<double> ChooseProbePatches(std::span<const ProbeHypothesis> hypotheses,
                                       const Activation& activation, int count,
                                       double noise_relative) {
  constexpr int kCandidates = 40;
  constexpr double kDarkest = 0.02;
  std::vector<double> candidates;
  for (int i = 0; i < kCandidates; ++i) {
    candidates.push_back(std::pow(kDarkest, 1 - static_cast<double>(i) / kCandidates));
  }
  std::vector<double> patches = {1};
  while (static_cast<int>(patches.size()) < count && !candidates.empty()) {
    size_t best = 0;
    double largest = -1;
    for (size_t i = 0; i < candidates.size(); ++i) {
      std::vector<double> tried = patches;
      tried.push_back(candidates[i]);
      double smallest = std::numeric_limits<double>::infinity();
      for (const ProbeHypothesis& truth : hypotheses) {
        for (const ProbeHypothesis& model : hypotheses) {
          // A free exponent imitates others at its own price, whatever the patches.
          if (&truth == &model || model.has_exponent()) continue;
          smallest =
              std::min(smallest, ProbeSeparation(truth, model, activation, tried, noise_relative));
        }
      }
      if (smallest <= largest) continue;
      largest = smallest;
      best = i;
    }
    patches.push_back(candidates[best]);
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(best));
  }
  std::ranges::sort(patches);
  return patches;
}

absl::StatusOr<ProbeVerdict> JudgeProbe(std::span<const ProbeHypothesis> hypotheses,
                                        const Activation& activation,
                                        std::span<const ProbeReading> readings) {
  constexpr size_t kFewest = 4;
  if (readings.size() < kFewest) {
    return Rejected("probe readings", absl::StrCat(readings.size(), " are too few"),
                    "read at least 4 of the patches");
  }
  std::vector<ProbeReading> blurred(readings.begin(), readings.end());
  for (size_t i = 0; i < blurred.size(); ++i) {
    ProbeReading& reading = blurred[i];
    if (!(reading.u > 0) || !(reading.luminance > 0) || !(reading.sigma > 0) ||
        std::isinf(reading.luminance) || std::isinf(reading.sigma)) {
      return BadInput(absl::StrCat("probe reading ", i + 1),
                      "u, luminance and sigma are not all above 0", "read the patch again");
    }
  }
  ProbeVerdict verdict;

  double largest = -std::numeric_limits<double>::infinity();
  for (const ProbeHypothesis& hypothesis : hypotheses) {
    // Rounding scales with what is shown, whatever the instrument's unit.
    const double scale = FitHypothesis(hypothesis, activation, readings).scale;
    for (size_t i = 0; i < blurred.size(); ++i) {
      blurred[i].sigma = std::hypot(
          readings[i].sigma, scale * hypotheses.front().OutputSigma(activation, readings[i].u));
    }
    ProbeLikelihood likelihood = FitHypothesis(hypothesis, activation, blurred);
    double log_sigmas = 0;
    for (const ProbeReading& reading : blurred) log_sigmas += std::log(reading.sigma);
    likelihood.log_likelihood_ratio =
        -likelihood.chi_square / 2 - log_sigmas + likelihood.log_occam;
    largest = std::max(largest, likelihood.log_likelihood_ratio);
    verdict.likelihoods.push_back(likelihood);
  }
  double sum = 0;
  for (ProbeLikelihood& likelihood : verdict.likelihoods) {
    likelihood.log_likelihood_ratio -= largest;
    likelihood.probability = std::exp(likelihood.log_likelihood_ratio);
    sum += likelihood.probability;
  }
  for (ProbeLikelihood& likelihood : verdict.likelihoods) likelihood.probability /= sum;
  Decide(hypotheses, readings.size(), verdict);
  return verdict;
}

}  // namespace eyebox::fit
