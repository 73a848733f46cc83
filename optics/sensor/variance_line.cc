#include "optics/sensor/variance_line.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr double kQuantisationDn2 = 1.0 / 12;  // no measured variance of counts is known better
constexpr double kTrustedSigmas = 2.5;
constexpr int kIterations = 30;

double ValueAt(const VarianceLine& line, double signal_dn) {
  return line.intercept_dn2 + signal_dn * (line.slope_dn + signal_dn * line.texture);
}

double PredictedVariance(const VarianceLine& line, double signal_dn) {
  return std::max(ValueAt(line, signal_dn), kQuantisationDn2);
}

double StandardScore(const VarianceLine& line, const PhotonTransferPoint& point) {
  const double predicted = PredictedVariance(line, point.signal_dn);
  return (point.variance_dn2 - ValueAt(line, point.signal_dn)) /
         (predicted * std::sqrt(2 / point.degrees_of_freedom));
}

// Falls with the fourth power beyond the trusted scatter, so that neither the line nor its chi^2
// feels a point far above. `scatter` is in standard deviations; infinite trusts every point.
double Trust(double score, double scatter) {
  const double excess = score / (kTrustedSigmas * scatter);
  return excess > 1 ? 1 / (excess * excess * excess * excess) : 1;
}

// Of the points below the line: texture only ever lifts a point, so that those above tell nothing.
double MedianScatter(std::span<const PhotonTransferPoint> points, const VarianceLine& line) {
  std::vector<float> scores;
  for (const PhotonTransferPoint& point : points) {
    const auto score = static_cast<float>(StandardScore(line, point));
    if (score <= 0) scores.push_back(-score);
  }
  if (scores.empty()) return 1;
  return std::max(1.4826 * Median(std::move(scores)), 1.0);
}

// From the lower quartile of the points' slopes: a start that textured points cannot lift unless
// they are three quarters of all.
VarianceLine StartingLine(std::span<const PhotonTransferPoint> points) {
  const auto lowest =
      std::min_element(points.begin(), points.end(),
                       [](const auto& a, const auto& b) { return a.signal_dn < b.signal_dn; });
  VarianceLine line;
  line.intercept_dn2 = lowest->variance_dn2;
  std::vector<double> slopes;
  for (const PhotonTransferPoint& point : points) {
    const double run = point.signal_dn - lowest->signal_dn;
    if (run > 0) slopes.push_back((point.variance_dn2 - lowest->variance_dn2) / run);
  }
  if (slopes.empty()) return line;
  const auto quartile = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 4);
  std::nth_element(slopes.begin(), quartile, slopes.end());
  line.slope_dn = std::max(*quartile, 0.0);
  return line;
}

// One step of weighted least squares for the first `terms` of intercept, slope and texture. False
// if the points do not determine them.
bool Improve(std::span<const PhotonTransferPoint> points, double scatter, int terms,
             VarianceLine& line) {
  // In units of the largest signal, so that the powers are of one size.
  double unit_dn = 0;
  for (const PhotonTransferPoint& point : points) unit_dn = std::max(unit_dn, point.signal_dn);
  if (!(unit_dn > 0)) return false;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(terms, terms);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(terms);
  for (const PhotonTransferPoint& point : points) {
    const double predicted = PredictedVariance(line, point.signal_dn);
    const double w = Trust(StandardScore(line, point), scatter) * point.degrees_of_freedom /
                     (2 * predicted * predicted);
    const double s = point.signal_dn / unit_dn;
    const Eigen::VectorXd row = Eigen::Vector3d(1, s, s * s).head(terms);
    normal += w * row * row.transpose();
    right += w * point.variance_dn2 * row;
  }
  const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  const Eigen::MatrixXd correlation =
      scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
  const Eigen::FullPivLU<Eigen::MatrixXd> factors(correlation);
  if (!(factors.determinant() > 1e-12)) return false;
  const Eigen::VectorXd solution = factors.solve(right.cwiseQuotient(scale)).cwiseQuotient(scale);
  const Eigen::VectorXd sigma = factors.inverse().diagonal().cwiseSqrt().cwiseQuotient(scale);
  line.intercept_dn2 = solution[0];
  line.slope_dn = solution[1] / unit_dn;
  line.texture = terms > 2 ? solution[2] / (unit_dn * unit_dn) : 0;
  line.intercept_sigma_dn2 = sigma[0];
  line.slope_sigma_dn = sigma[1] / unit_dn;
  return true;
}

void ScaleByChi2(std::span<const PhotonTransferPoint> points, double scatter, int terms,
                 VarianceLine& line) {
  double chi2 = 0;
  double trusted = 0;
  for (const PhotonTransferPoint& point : points) {
    const double score = StandardScore(line, point);
    const double trust = Trust(score, scatter);
    chi2 += trust * score * score;
    trusted += trust;
  }
  line.reduced_chi2 = trusted > terms ? chi2 / (trusted - terms) : 0;
  const double scale = std::sqrt(std::max(line.reduced_chi2, 1.0));
  line.slope_sigma_dn *= scale;
  line.intercept_sigma_dn2 *= scale;
}

template <typename ScatterOf>
VarianceLine Iterate(std::span<const PhotonTransferPoint> points, int terms,
                     const ScatterOf& scatter_of) {
  if (points.size() < static_cast<size_t>(terms)) return {};
  VarianceLine line = StartingLine(points);
  for (int i = 0; i < kIterations; ++i) {
    if (!Improve(points, scatter_of(line), terms, line)) return {};
  }
  ScaleByChi2(points, scatter_of(line), terms, line);
  return line;
}

}  // namespace

VarianceLine FitVarianceLine(std::span<const PhotonTransferPoint> points) {
  return Iterate(points, 2,
                 [](const VarianceLine&) { return std::numeric_limits<double>::infinity(); });
}

VarianceLine FitTexturedVarianceLine(std::span<const PhotonTransferPoint> points) {
  const auto scatter_of = [&](const VarianceLine& line) { return MedianScatter(points, line); };
  const VarianceLine textured = Iterate(points, 3, scatter_of);
  return textured.texture > 0 ? textured : Iterate(points, 2, scatter_of);
}

}  // namespace eyebox::optics
