#include "fit/scatter/glare_covariance.h"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace eyebox::fit {
namespace {

constexpr double kOpen = 0.5;          // in logarithms: not even known to a factor of 1.65
constexpr double kLargestSigma = 1e6;  // keeps covariances finite
constexpr double kNamed = 0.2;         // components of a direction below this are not worth a word
constexpr double kInstrumentStep = 1e-3;
constexpr double kChance = 3;  // standard deviations of chi-square that count as chance

using Matrix = Eigen::MatrixXd;

Matrix JacobianAt(const GlareModel& model, const GlareCoordinates& optimum,
                  const std::vector<int>& free) {
  const GlareEvaluation found = model.Evaluate(optimum);
  Matrix jacobian(found.residuals.size(), free.size());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
    for (size_t k = 0; k < free.size(); ++k) {
      jacobian(i, static_cast<Eigen::Index>(k)) = found.jacobian[i * kGlareParameters + free[k]];
    }
  }
  return jacobian;
}

std::string Factor(double sigma) {
  if (sigma > 10) return "not at all";
  return absl::StrFormat("to a factor of %.2g only", std::exp(sigma));
}

std::string InWords(const OpenCombination& combination) {
  std::vector<std::string> parts;
  for (int i = 0; i < kGlareParameters; ++i) {
    if (std::abs(combination.direction[i]) < kNamed) continue;
    parts.push_back(absl::StrFormat("%+.2f %s", combination.direction[i], kGlareNames[i]));
  }
  if (parts.size() == 1) {
    const auto largest = std::ranges::max_element(
        combination.direction, {}, [](double component) { return std::abs(component); });
    return absl::StrCat(kGlareNames[largest - combination.direction.begin()], " is known ",
                        Factor(combination.sigma));
  }
  return absl::StrCat("the combination ", absl::StrJoin(parts, " "), " (in logarithms) is known ",
                      Factor(combination.sigma));
}

// Steepest singular direction last: the open ones are the trailing columns of V.
std::vector<OpenCombination> OpenOf(const Eigen::JacobiSVD<Matrix>& svd, double root_scale,
                                    const std::vector<int>& free) {
  std::vector<OpenCombination> open;
  for (Eigen::Index k = svd.matrixV().cols() - 1; k >= 0; --k) {
    const double singular = k < svd.singularValues().size() ? svd.singularValues()[k] : 0;
    const double sigma = std::min(root_scale / std::max(singular, 1e-300), kLargestSigma);
    if (sigma < kOpen) break;
    OpenCombination combination;
    combination.sigma = sigma;
    Eigen::Index largest = 0;
    svd.matrixV().col(k).cwiseAbs().maxCoeff(&largest);
    const double sign = svd.matrixV()(largest, k) < 0 ? -1 : 1;
    for (size_t i = 0; i < free.size(); ++i) {
      combination.direction[free[i]] = sign * svd.matrixV()(static_cast<Eigen::Index>(i), k);
    }
    combination.words = InWords(combination);
    open.push_back(std::move(combination));
  }
  return open;
}

// Derivatives of the residuals by the instrument's five parameters, in their own units.
Matrix InstrumentJacobian(const GlareModel& model, const GlareCoordinates& optimum) {
  const std::vector<double> base = model.Residuals(optimum);
  Matrix jacobian(base.size(), kKernelParameters);
  for (int j = 0; j < kKernelParameters; ++j) {
    ScatterFitOptions moved = model.options();
    optics::ScatterKernel& kernel = moved.instrument->kernel;
    const std::array<double*, kKernelParameters> fields = {
        &kernel.core_radius_deg, &kernel.tail_share, &kernel.tail_radius_deg, &kernel.tail_exponent,
        &kernel.pedestal_share};
    const double step = std::max(kInstrumentStep * *fields[j], 1e-5);
    *fields[j] += step;
    const std::vector<double> residuals = GlareModel(model.series(), moved).Residuals(optimum);
    for (size_t i = 0; i < base.size(); ++i) {
      jacobian(static_cast<Eigen::Index>(i), j) = (residuals[i] - base[i]) / step;
    }
  }
  return jacobian;
}

// How the optimum moves with the instrument: -(J^T J)^-1 J^T times what the residuals do.
Matrix InstrumentCovariance(const GlareModel& model, const GlareCoordinates& optimum,
                            const Matrix& half, const Matrix& jacobian) {
  const Eigen::Map<
      const Eigen::Matrix<double, kKernelParameters, kKernelParameters, Eigen::RowMajor>>
      known(model.options().instrument->covariance.data());
  const Matrix gain =
      half * (half.transpose() * (jacobian.transpose() * InstrumentJacobian(model, optimum)));
  return gain * known * gain.transpose();
}

// How far the optimum moves with the error that all readings share, 1 sigma of it.
Eigen::VectorXd SharedMove(const GlareModel& model, const Matrix& half, const Matrix& jacobian) {
  Eigen::VectorXd shared(jacobian.rows());
  for (Eigen::Index i = 0; i < shared.size(); ++i) {
    const GlareReading& reading = model.series().readings[static_cast<size_t>(i)];
    shared(i) = reading.shared_sigma / reading.luminance_sigma;
  }
  return half * (half.transpose() * (jacobian.transpose() * shared));
}

}  // namespace

GlareUncertainty MeasureUncertainty(const GlareModel& model, const GlareCoordinates& optimum,
                                    double scale) {
  const std::vector<int> free = model.Free();
  const Matrix jacobian = JacobianAt(model, optimum, free);
  const Eigen::JacobiSVD<Matrix> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeFullV);
  GlareUncertainty result;
  result.open = OpenOf(svd, std::sqrt(scale), free);
  std::vector<std::string> statements;
  for (const OpenCombination& open : result.open) statements.push_back(open.words);
  result.identifiability = result.open.empty() ? "the readings determine every free parameter"
                                               : absl::StrJoin(statements, "; ");

  const Eigen::VectorXd inverse = svd.singularValues().cwiseMax(1 / kLargestSigma).cwiseInverse();
  const Matrix half = svd.matrixV().leftCols(inverse.size()) * inverse.asDiagonal();
  const Eigen::VectorXd moved = SharedMove(model, half, jacobian);
  Matrix covariance = scale * half * half.transpose() + moved * moved.transpose();
  if (model.options().instrument.has_value()) {
    covariance += InstrumentCovariance(model, optimum, half, jacobian);
  }
  const auto derivatives = model.ValueDerivatives(optimum);
  Matrix to_values(kGlareParameters, free.size());
  for (int i = 0; i < kGlareParameters; ++i) {
    for (size_t k = 0; k < free.size(); ++k) {
      to_values(i, static_cast<Eigen::Index>(k)) = derivatives[i][free[k]];
    }
  }
  Matrix values = to_values * covariance * to_values.transpose();
  std::vector<bool> is_free(kGlareParameters, false);
  for (const int i : free) is_free[i] = true;
  for (int i = 0; i < kGlareParameters; ++i) {
    for (int j = 0; j < kGlareParameters; ++j) {
      result.covariance[i * kGlareParameters + j] = is_free[i] && is_free[j] ? values(i, j) : 0;
    }
  }
  return result;
}

double ExcessScatter(double chi_square, int degrees_of_freedom) {
  if (degrees_of_freedom <= 0) return 1;
  const double expected = degrees_of_freedom;
  const bool chance = chi_square <= expected + kChance * std::sqrt(2 * expected);
  return chance ? 1 : chi_square / expected;
}

void StateSigmas(ScatterFit& fit) {
  const auto at = [&](int i, int j) { return fit.covariance[i * kGlareParameters + j]; };
  for (int i = 0; i < kGlareParameters; ++i) {
    fit.parameters[i].sigma = std::sqrt(std::max(at(i, i), 0.0));
  }
  const double share = fit.kernel.tail_share + fit.kernel.pedestal_share;
  const double variance = at(kTailShare, kTailShare) + at(kPedestalShare, kPedestalShare) +
                          2 * at(kTailShare, kPedestalShare);
  fit.glare_relative_sigma = share > 0 ? std::sqrt(std::max(variance, 0.0)) / share : 0;
}

void AddToCovariance(const std::array<double, kGlareParameters>& moved, ScatterFit& fit) {
  for (int i = 0; i < kGlareParameters; ++i) {
    for (int j = 0; j < kGlareParameters; ++j) {
      fit.covariance[i * kGlareParameters + j] += moved[i] * moved[j];
    }
  }
  StateSigmas(fit);
}

}  // namespace eyebox::fit
