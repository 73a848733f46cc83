#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/reduce/linearise.h"

namespace eyebox::optics {
namespace {

constexpr size_t kFewestPairs = 3;
constexpr double kGaugeSigma = 1e-9;  // of the relative correction at the reference

bool IsUsable(const LinearityPair& pair) {
  return pair.shorter_dn > 0 && pair.longer_dn > pair.shorter_dn && pair.ratio > 1 &&
         std::isfinite(pair.ratio) && pair.shorter_variance_dn2 >= 0 &&
         pair.longer_variance_dn2 >= 0;
}

// Knots spaced evenly in the logarithm; corrected = knot (1 + c) with c unknown at each.
class CorrectionFit {
 public:
  CorrectionFit(std::span<const LinearityPair> pairs, const LinearityOptions& options)
      : options_(options) {
    double lowest = INFINITY;
    double highest = 0;
    for (const LinearityPair& pair : pairs) {
      lowest = std::min(lowest, pair.shorter_dn);
      highest = std::max(highest, pair.longer_dn);
    }
    const double octaves = std::log2(highest / lowest);
    const int spans = std::max(1, static_cast<int>(std::ceil(octaves * options.knots_per_octave)));
    for (int k = 0; k <= spans; ++k) knots_.push_back(lowest * std::exp2(octaves * k / spans));
    reference_ = options.reference_dn > 0 ? options.reference_dn : 0.5 * highest;
    const auto size = static_cast<Eigen::Index>(knots_.size());
    data_ = Eigen::MatrixXd::Zero(size, size);
    prior_ = Eigen::MatrixXd::Zero(size, size);
    right_ = Eigen::VectorXd::Zero(size);
    AddPrior();
  }

  void Add(const LinearityPair& pair) {
    const Eigen::VectorXd row = RowOf(pair);
    const double sigma = SigmaOf(pair);
    data_ += row * row.transpose() / (sigma * sigma);
    right_ -= row * ((pair.longer_dn - pair.ratio * pair.shorter_dn) / (sigma * sigma));
  }

  LinearityCurve Solve(std::span<const LinearityPair> pairs) const {
    const Eigen::LDLT<Eigen::MatrixXd> factors(data_ + prior_);
    const Eigen::VectorXd c = factors.solve(right_);
    const Eigen::MatrixXd covariance =
        factors.solve(Eigen::MatrixXd::Identity(data_.rows(), data_.cols()));
    double chi2 = 0;
    for (const LinearityPair& pair : pairs) {
      const double residual = pair.longer_dn - pair.ratio * pair.shorter_dn + RowOf(pair).dot(c);
      chi2 += std::pow(residual / SigmaOf(pair), 2);
    }
    const double freedom = static_cast<double>(pairs.size()) - (covariance * data_).trace();
    LinearityCurve curve;
    curve.reduced_chi2 = freedom > 0.5 ? chi2 / freedom : 0;
    curve.pairs = static_cast<int>(pairs.size());
    curve.reference_dn = reference_;
    curve.from_dn = knots_.front();
    curve.to_dn = knots_.back();
    curve.knots_dn = {0};
    curve.corrected_dn = {0};
    curve.variance_dn2 = {0};
    const double excess = std::max(curve.reduced_chi2, 1.0);
    for (size_t k = 0; k < knots_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      curve.knots_dn.push_back(knots_[k]);
      curve.corrected_dn.push_back(knots_[k] * (1 + c[i]));
      curve.variance_dn2.push_back(knots_[k] * knots_[k] * std::max(covariance(i, i), 0.0) *
                                   excess);
    }
    return curve;
  }

 private:
  // corrected(y) - y as a linear form of the c.
  Eigen::VectorXd FormOf(double dn) const {
    Eigen::VectorXd form = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(knots_.size()));
    if (dn <= knots_.front()) {
      form[0] = dn;
      return form;
    }
    const auto above = std::lower_bound(knots_.begin(), knots_.end() - 1, dn);
    const auto k = above - knots_.begin();
    const double part = std::min((dn - knots_[k - 1]) / (knots_[k] - knots_[k - 1]), 1.0);
    form[k - 1] = (1 - part) * knots_[k - 1];
    form[k] = part * knots_[k];
    return form;
  }

  Eigen::VectorXd RowOf(const LinearityPair& pair) const {
    return FormOf(pair.longer_dn) - pair.ratio * FormOf(pair.shorter_dn);
  }

  double SigmaOf(const LinearityPair& pair) const {
    const double floor_dn = options_.relative_floor * pair.longer_dn;
    return std::sqrt(pair.longer_variance_dn2 +
                     pair.ratio * pair.ratio * pair.shorter_variance_dn2 + floor_dn * floor_dn);
  }

  void AddPrior() {
    const double weight = 1 / (options_.smoothness * options_.smoothness);
    for (Eigen::Index k = 1; k + 1 < prior_.rows(); ++k) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(prior_.rows());
      row[k - 1] = row[k + 1] = 1;
      row[k] = -2;
      prior_ += weight * row * row.transpose();
    }
    const Eigen::VectorXd gauge = FormOf(reference_) / reference_;
    prior_ += gauge * gauge.transpose() / (kGaugeSigma * kGaugeSigma);
  }

  LinearityOptions options_;
  std::vector<double> knots_;
  double reference_ = 0;
  Eigen::MatrixXd data_;
  Eigen::MatrixXd prior_;
  Eigen::VectorXd right_;
};

}  // namespace

absl::StatusOr<LinearityCurve> EstimateLinearity(std::span<const LinearityPair> pairs,
                                                 const LinearityOptions& options) {
  std::vector<LinearityPair> usable;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(usable), IsUsable);
  if (usable.size() < kFewestPairs) {
    return Rejected("linearity", absl::StrCat(usable.size(), " pairs of exposures can be compared"),
                    "record at least three, of one constant light, from faint to near saturation");
  }
  CorrectionFit fit(usable, options);
  for (const LinearityPair& pair : usable) fit.Add(pair);
  LinearityCurve curve = fit.Solve(usable);
  for (size_t k = 1; k < curve.knots_dn.size(); ++k) {
    if (!(curve.corrected_dn[k] > curve.corrected_dn[k - 1])) {
      return Rejected("linearity",
                      absl::StrCat("between ", curve.knots_dn[k - 1], " and ", curve.knots_dn[k],
                                   " DN the pairs ask for a correction that does not rise"),
                      "check that the light was constant and the exposure times are as stated");
    }
  }
  return curve;
}

}  // namespace eyebox::optics
