#include "optics/uniformity/cross_validate.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/uniformity/normal_equations.h"
#include "optics/uniformity/order_weights.h"

namespace eyebox::optics {
namespace {

constexpr int kFolds = 5;
constexpr int kLongestSide = 384;
constexpr int kIntervals[] = {1, 2, 3, 4, 6, 8, 12, 16};

// Prediction of each class from the others, of the first `terms` functions; nullopt where they do
// not determine it. Penalties: one for each of them, or none.
std::optional<double> HeldOutChi2(const std::vector<NormalEquations>& folds,
                                  const NormalEquations& all, size_t terms,
                                  const std::vector<double>& penalties = {}) {
  double chi2 = 0;
  for (const NormalEquations& fold : folds) {
    NormalEquations rest = all;
    rest -= fold;
    if (rest.pixels < terms) return std::nullopt;
    const auto solution = Minimise(rest, terms, penalties);
    if (!solution) return std::nullopt;
    chi2 += std::max(fold.Chi2(*solution), 0.0);
  }
  return chi2 / static_cast<double>(all.pixels);
}

NormalEquations SumOf(const std::vector<NormalEquations>& folds) {
  NormalEquations all = folds.front();
  for (size_t k = 1; k < folds.size(); ++k) all += folds[k];
  return all;
}

// Those of the first functions of the basis.
NormalEquations FirstOf(const NormalEquations& all, size_t terms) {
  NormalEquations first = all;
  first.right_side.resize(terms);
  first.matrix.resize(terms * terms);
  for (size_t i = 0; i < terms; ++i) {
    std::copy_n(all.matrix.begin() + i * all.right_side.size(), terms,
                first.matrix.begin() + i * terms);
  }
  return first;
}

const CrossValidated& BestOf(const std::vector<CrossValidated>& models) {
  return *std::ranges::min_element(models, {}, &CrossValidated::held_out_chi2);
}

// All orders from one pass: the functions of a lower order come first. Then all of them, weighted.
void ValidatePolynomials(const MeasuredImage& image, FieldChoice& choice) {
  const FieldBasis basis(FieldModel::kPolynomial, kLargestOrder, image.size());
  const auto folds = SumImage(image, basis, kFolds);
  const NormalEquations all = SumOf(folds);
  std::vector<CrossValidated>& models = choice.polynomials;
  for (int order = 0; order <= kLargestOrder; ++order) {
    const size_t terms = FieldBasis(FieldModel::kPolynomial, order, image.size()).Terms().size();
    const auto chi2 = HeldOutChi2(folds, all, terms);
    if (!chi2) break;
    models.push_back({FieldModel::kPolynomial, order, *chi2});
  }
  if (models.empty()) return;
  choice.weighted = models.back();
  if (choice.weighted.size < kLeastWeightedOrder) return;
  const FieldBasis weighted(FieldModel::kPolynomial, choice.weighted.size, image.size());
  const NormalEquations equations = FirstOf(all, weighted.Terms().size());
  const auto chi2 =
      HeldOutChi2(folds, all, weighted.Terms().size(), OrderPenalties(equations, weighted));
  // Penalties only make it better determined than the same order without them, which it is.
  choice.weighted.held_out_chi2 = chi2.value_or(std::numeric_limits<double>::infinity());
}

std::vector<CrossValidated> ValidateSplines(const MeasuredImage& image) {
  std::vector<CrossValidated> models;
  for (const int intervals : kIntervals) {
    const FieldBasis basis(FieldModel::kSpline, intervals, image.size());
    const auto folds = SumImage(image, basis, kFolds);
    const auto chi2 = HeldOutChi2(folds, SumOf(folds), basis.Terms().size());
    if (!chi2) break;
    models.push_back({FieldModel::kSpline, intervals, *chi2});
  }
  return models;
}

}  // namespace

absl::StatusOr<FieldChoice> CrossValidate(const MeasuredImage& image) {
  const int longest = std::max(image.size().width_px, image.size().height_px);
  const MeasuredImage binned = Binned(image, (longest + kLongestSide - 1) / kLongestSide);
  FieldChoice choice;
  ValidatePolynomials(binned, choice);
  if (choice.polynomials.empty()) {
    return Rejected("smooth field", "too few valid pixels for any model",
                    "record exposures with more valid pixels");
  }
  choice.splines = ValidateSplines(binned);
  choice.polynomial = BestOf(choice.polynomials);
  if (choice.splines.empty()) return choice;
  choice.spline = BestOf(choice.splines);
  choice.spline_is_better = choice.spline.held_out_chi2 < choice.weighted.held_out_chi2;
  return choice;
}

MeasuredImage Binned(const MeasuredImage& image, int block_px) {
  if (block_px <= 1) return image;
  const auto [width, height] = image.size();
  MeasuredImage binned = MakeMeasuredImage(
      {(width + block_px - 1) / block_px, (height + block_px - 1) / block_px}, image.unit);
  Image<int> count(binned.size(), 0);
  Image<double> sum(binned.size(), 0.0);
  Image<double> variance(binned.size(), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (image.mask.at(x, y) != 0) continue;
      ++count.at(x / block_px, y / block_px);
      sum.at(x / block_px, y / block_px) += image.value.at(x, y);
      variance.at(x / block_px, y / block_px) += image.variance.at(x, y);
    }
  }
  for (size_t i = 0; i < count.pixels().size(); ++i) {
    const double n = count.pixels()[i];
    if (n == 0) {
      binned.mask.pixels()[i] = kNoData;
      continue;
    }
    binned.value.pixels()[i] = static_cast<float>(sum.pixels()[i] / n);
    binned.variance.pixels()[i] = static_cast<float>(variance.pixels()[i] / (n * n));
  }
  BlankMaskedPixels(binned);
  return binned;
}

}  // namespace eyebox::optics
