#include "optics/sensor/variance_line.h"

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

struct Sums {
  double w = 0, ws = 0, wss = 0, wv = 0, wsv = 0;
};

double PredictedVariance(const VarianceLine& line, double signal_dn) {
  return std::max(line.intercept_dn2 + line.slope_dn * signal_dn, kQuantisationDn2);
}

double StandardScore(const VarianceLine& line, const PhotonTransferPoint& point) {
  const double predicted = PredictedVariance(line, point.signal_dn);
  return (point.variance_dn2 - line.intercept_dn2 - line.slope_dn * point.signal_dn) /
         (predicted * std::sqrt(2 / point.degrees_of_freedom));
}

// Falls with the fourth power beyond the trusted scatter, so that neither the line nor its chi^2
// feels a point far above. `scatter` is in standard deviations; infinite trusts every point.
double Trust(double score, double scatter) {
  const double excess = score / (kTrustedSigmas * scatter);
  return excess > 1 ? 1 / (excess * excess * excess * excess) : 1;
}

double MedianScatter(std::span<const PhotonTransferPoint> points, const VarianceLine& line) {
  std::vector<float> scores;
  for (const PhotonTransferPoint& point : points) {
    scores.push_back(static_cast<float>(std::abs(StandardScore(line, point))));
  }
  return std::max(1.4826 * Median(std::move(scores)), 1.0);
}

// From the median of the points' slopes: a start that a minority of textured points cannot lift.
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
  const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
  std::nth_element(slopes.begin(), middle, slopes.end());
  line.slope_dn = std::max(*middle, 0.0);
  return line;
}

bool Improve(std::span<const PhotonTransferPoint> points, double scatter, VarianceLine& line) {
  Sums s;
  for (const PhotonTransferPoint& point : points) {
    const double predicted = PredictedVariance(line, point.signal_dn);
    const double w = Trust(StandardScore(line, point), scatter) * point.degrees_of_freedom /
                     (2 * predicted * predicted);
    s.w += w;
    s.ws += w * point.signal_dn;
    s.wss += w * point.signal_dn * point.signal_dn;
    s.wv += w * point.variance_dn2;
    s.wsv += w * point.signal_dn * point.variance_dn2;
  }
  const double determinant = s.w * s.wss - s.ws * s.ws;
  if (!(determinant > 1e-12 * s.w * s.wss)) return false;
  line.slope_dn = (s.w * s.wsv - s.ws * s.wv) / determinant;
  line.intercept_dn2 = (s.wss * s.wv - s.ws * s.wsv) / determinant;
  line.slope_sigma_dn = std::sqrt(s.w / determinant);
  line.intercept_sigma_dn2 = std::sqrt(s.wss / determinant);
  return true;
}

void ScaleByChi2(std::span<const PhotonTransferPoint> points, double scatter, VarianceLine& line) {
  double chi2 = 0;
  double trusted = 0;
  for (const PhotonTransferPoint& point : points) {
    const double score = StandardScore(line, point);
    const double trust = Trust(score, scatter);
    chi2 += trust * score * score;
    trusted += trust;
  }
  line.reduced_chi2 = trusted > 2 ? chi2 / (trusted - 2) : 0;
  const double scale = std::sqrt(std::max(line.reduced_chi2, 1.0));
  line.slope_sigma_dn *= scale;
  line.intercept_sigma_dn2 *= scale;
}

template <typename ScatterOf>
VarianceLine Iterate(std::span<const PhotonTransferPoint> points, const ScatterOf& scatter_of) {
  if (points.size() < 2) return {};
  VarianceLine line = StartingLine(points);
  for (int i = 0; i < kIterations; ++i) {
    if (!Improve(points, scatter_of(line), line)) return {};
  }
  ScaleByChi2(points, scatter_of(line), line);
  return line;
}

}  // namespace

VarianceLine FitVarianceLine(std::span<const PhotonTransferPoint> points) {
  return Iterate(points,
                 [](const VarianceLine&) { return std::numeric_limits<double>::infinity(); });
}

VarianceLine FitLowerVarianceLine(std::span<const PhotonTransferPoint> points) {
  return Iterate(points, [&](const VarianceLine& line) { return MedianScatter(points, line); });
}

}  // namespace eyebox::optics
