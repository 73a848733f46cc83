#include "optics/photometry/colour_matrix.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "Eigen/Core"
#include "Eigen/QR"
#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestSamples = 4;
constexpr double kIndependent = 1e-8;  // of columns scaled to one length

absl::Status Check(std::span<const ColourSample> samples) {
  if (samples.size() < kFewestSamples) {
    return BadInput("colour", absl::StrCat(samples.size(), " samples"),
                    "give at least 4 lights: the primaries and white");
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const ColourSample& sample = samples[i];
      if (std::isfinite(sample.signal[k] + sample.xyz[k] + sample.xyz_sigma[k]) &&
          sample.xyz_sigma[k] >= 0) {
        continue;
      }
      return BadInput(absl::StrCat("sample ", i + 1), "is not finite, or has a sigma below 0",
                      "give three signals, X, Y, Z and their sigmas");
    }
  }
  return absl::OkStatus();
}

struct Row {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd left_out;  // error of each sample, predicted without itself
};

absl::StatusOr<Row> FitRow(std::span<const ColourSample> samples, int row, int columns,
                           bool weighted) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd design(count, columns);
  Eigen::VectorXd target(count);
  Eigen::VectorXd sigma(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ColourSample& sample = samples[static_cast<size_t>(i)];
    sigma(i) = weighted ? sample.xyz_sigma[row] : 1;
    for (int k = 0; k < columns; ++k) design(i, k) = (k < 3 ? sample.signal[k] : 1) / sigma(i);
    target(i) = sample.xyz[row] / sigma(i);
  }
  const Eigen::RowVectorXd length = design.colwise().norm();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns, columns);
  if (length.minCoeff() > 0) {
    qr.setThreshold(kIndependent);
    qr.compute(design * length.cwiseInverse().asDiagonal());
  }
  if (!(length.minCoeff() > 0) || qr.rank() < columns) {
    return Rejected("colour", "the lights do not tell the three signals apart",
                    "measure the primaries one by one, and mixtures");
  }
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(count, columns);
  Row fit;
  fit.coefficients = qr.solve(target).cwiseQuotient(length.transpose());
  const Eigen::MatrixXd inverse_r =
      qr.matrixR().topRows(columns).triangularView<Eigen::Upper>().solve(
          Eigen::MatrixXd::Identity(columns, columns));
  const Eigen::MatrixXd root =
      length.cwiseInverse().asDiagonal() * (qr.colsPermutation() * inverse_r);
  fit.covariance = root * root.transpose();
  const Eigen::VectorXd residual = target - design * fit.coefficients;
  if (!weighted && count > columns) {
    fit.covariance *= residual.squaredNorm() / static_cast<double>(count - columns);
  }
  const Eigen::VectorXd leverage = q.rowwise().squaredNorm();
  fit.left_out = residual.array() / (1 - leverage.array()) * sigma.array();
  return fit;
}

struct Matrix {
  std::vector<Row> rows;
  double leave_one_out_rms = std::numeric_limits<double>::quiet_NaN();
};

absl::StatusOr<Matrix> FitRows(std::span<const ColourSample> samples, int columns, bool weighted) {
  Matrix matrix;
  double sum = 0;
  for (int row = 0; row < 3; ++row) {
    EYEBOX_ASSIGN_OR_RETURN(Row fit, FitRow(samples, row, columns, weighted));
    sum += fit.left_out.squaredNorm();
    matrix.rows.push_back(std::move(fit));
  }
  double largest = 0;
  for (const ColourSample& sample : samples) largest = std::max(largest, std::abs(sample.xyz[1]));
  const double rms = std::sqrt(sum / (3 * static_cast<double>(samples.size()))) / largest;
  // A sample that alone carries a coefficient cannot be predicted without itself.
  if (std::isfinite(rms) && static_cast<int>(samples.size()) > columns)
    matrix.leave_one_out_rms = rms;
  return matrix;
}

}  // namespace

std::array<double, 3> ColourMatrix::Xyz(const std::array<double, 3>& signal) const {
  std::array<double, 3> xyz = {};
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < columns; ++k) {
      xyz[row] += matrix[row * columns + k] * (k < 3 ? signal[k] : 1);
    }
  }
  return xyz;
}

std::array<double, 3> ColourMatrix::XyzSigma(const std::array<double, 3>& signal) const {
  std::array<double, 3> sigma = {};
  const auto factor = [&signal](int k) { return k < 3 ? signal[k] : 1; };
  for (int row = 0; row < 3; ++row) {
    double variance = 0;
    for (int j = 0; j < columns; ++j) {
      for (int k = 0; k < columns; ++k) {
        variance += factor(j) * factor(k) * covariance[(row * columns + j) * columns + k];
      }
    }
    sigma[row] = std::sqrt(std::max(variance, 0.0));
  }
  return sigma;
}

absl::StatusOr<ColourMatrix> FitColourMatrix(std::span<const ColourSample> samples) {
  EYEBOX_RETURN_IF_ERROR(Check(samples));
  const bool weighted = std::ranges::all_of(samples, [](const ColourSample& sample) {
    return std::ranges::all_of(sample.xyz_sigma, [](double sigma) { return sigma > 0; });
  });
  EYEBOX_ASSIGN_OR_RETURN(Matrix best, FitRows(samples, 3, weighted));
  ColourMatrix result;
  result.leave_one_out_rms_3 = best.leave_one_out_rms;
  result.leave_one_out_rms_4 = std::numeric_limits<double>::quiet_NaN();
  // What is not determined is no alternative.
  if (auto with_constant = FitRows(samples, 4, weighted); with_constant.ok()) {
    result.leave_one_out_rms_4 = with_constant->leave_one_out_rms;
    if (result.leave_one_out_rms_4 < result.leave_one_out_rms_3) {
      result.columns = 4;
      best = *std::move(with_constant);
    }
  }
  for (const Row& row : best.rows) {
    result.matrix.insert(result.matrix.end(), row.coefficients.begin(), row.coefficients.end());
    for (Eigen::Index i = 0; i < row.covariance.rows(); ++i) {
      for (Eigen::Index j = 0; j < row.covariance.cols(); ++j) {
        result.covariance.push_back(row.covariance(i, j));
      }
    }
  }
  return result;
}

}  // namespace eyebox::optics
