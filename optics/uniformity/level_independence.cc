#include "optics/uniformity/level_independence.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/uniformity/chi_square.h"

namespace eyebox::optics {
namespace {

constexpr int kMostRounds = 200;
constexpr double kSettled = 1e-9;  // of chi2, relative
constexpr double kFails = 0.05;

std::vector<size_t> ValidEverywhere(const std::vector<LevelBlocks>& levels) {
  std::vector<size_t> valid;
  for (size_t i = 0; i < levels.front().blocks.mask.pixels().size(); ++i) {
    const bool everywhere = std::ranges::all_of(
        levels, [i](const LevelBlocks& level) { return level.blocks.mask.pixels()[i] == 0; });
    if (everywhere) valid.push_back(i);
  }
  return valid;
}

absl::Status Check(const std::vector<LevelBlocks>& levels) {
  if (levels.size() < 2) {
    return Rejected("level independence", absl::StrCat(levels.size(), " levels"),
                    "record full fields of at least 2 levels");
  }
  for (const LevelBlocks& level : levels) {
    if (level.blocks.size() != levels.front().blocks.size()) {
      return BadInput(absl::StrCat("level of drive ", level.drive), "has another size",
                      "give levels of one camera in the same blocks");
    }
  }
  return absl::OkStatus();
}

// [levels] x [blocks] as one product.
class Product {
 public:
  Product(const std::vector<LevelBlocks>& levels, const std::vector<size_t>& valid)
      : levels_(levels), valid_(valid), a_(levels.size(), 0), g_(valid.size(), 1) {}

  void Fit() {
    double before = HUGE_VAL;
    for (int round = 0; round < kMostRounds; ++round) {
      FitLevels();
      FitBlocks();
      const double chi2 = Chi2();
      if (before - chi2 <= kSettled * chi2) break;
      before = chi2;
    }
    double mean = 0;
    for (const double g : g_) mean += g / static_cast<double>(g_.size());
    for (double& g : g_) g /= mean;
    for (double& a : a_) a *= mean;
  }

  double Residual2(size_t level, size_t block) const {
    const double residual = Value(level, block) - a_[level] * g_[block];
    return residual * residual / Variance(level, block);
  }
  double a(size_t level) const { return a_[level]; }
  double g(size_t block) const { return g_[block]; }
  double Value(size_t level, size_t block) const {
    return levels_[level].blocks.value.pixels()[valid_[block]];
  }
  double Variance(size_t level, size_t block) const {
    return levels_[level].blocks.variance.pixels()[valid_[block]];
  }

 private:
  void FitLevels() {
    for (size_t l = 0; l < a_.size(); ++l) {
      double top = 0, bottom = 0;
      for (size_t b = 0; b < g_.size(); ++b) {
        top += Value(l, b) * g_[b] / Variance(l, b);
        bottom += g_[b] * g_[b] / Variance(l, b);
      }
      a_[l] = top / bottom;
    }
  }
  void FitBlocks() {
    for (size_t b = 0; b < g_.size(); ++b) {
      double top = 0, bottom = 0;
      for (size_t l = 0; l < a_.size(); ++l) {
        top += Value(l, b) * a_[l] / Variance(l, b);
        bottom += a_[l] * a_[l] / Variance(l, b);
      }
      g_[b] = top / bottom;
    }
  }
  double Chi2() const {
    double chi2 = 0;
    for (size_t l = 0; l < a_.size(); ++l) {
      for (size_t b = 0; b < g_.size(); ++b) chi2 += Residual2(l, b);
    }
    return chi2;
  }

  const std::vector<LevelBlocks>& levels_;
  const std::vector<size_t>& valid_;
  std::vector<double> a_;
  std::vector<double> g_;
};

// Relative scatter about the shared g, less what the noise makes up.
LevelAgainstShared Compare(const Product& product, size_t level, double drive, size_t blocks) {
  LevelAgainstShared result{drive, product.a(level), 0, 0};
  double squares = 0, noise = 0;
  for (size_t b = 0; b < blocks; ++b) {
    result.chi2 += product.Residual2(level, b);
    const double shared = product.a(level) * product.g(b);
    squares += std::pow((product.Value(level, b) - shared) / shared, 2);
    noise += product.Variance(level, b) / (shared * shared);
  }
  result.excess_relative = std::sqrt(std::max(squares - noise, 0.0) / static_cast<double>(blocks));
  return result;
}

// Levels that are lit: a level of nothing but noise says nothing about g.
std::vector<LevelBlocks> Lit(const std::vector<LevelBlocks>& levels,
                             const std::vector<size_t>& valid) {
  std::vector<LevelBlocks> lit;
  for (const LevelBlocks& level : levels) {
    double sum = 0, variance = 0;
    for (const size_t i : valid) {
      sum += level.blocks.value.pixels()[i];
      variance += level.blocks.variance.pixels()[i];
    }
    if (sum > 5 * std::sqrt(variance)) lit.push_back(level);
  }
  return lit;
}

}  // namespace

absl::StatusOr<LevelIndependence> TestLevelIndependence(const std::vector<LevelBlocks>& levels) {
  EYEBOX_RETURN_IF_ERROR(Check(levels));
  const std::vector<size_t> valid = ValidEverywhere(levels);
  const std::vector<LevelBlocks> lit = Lit(levels, valid);
  if (valid.size() < 2 || lit.size() < 2) {
    return Rejected("level independence",
                    absl::StrCat(lit.size(), " lit levels with ", valid.size(),
                                 " blocks that are valid at all of them"),
                    "record at least 2 levels that are lit and do not saturate");
  }
  Product product(lit, valid);
  product.Fit();
  LevelIndependence result;
  result.blocks = valid.size();
  for (size_t l = 0; l < lit.size(); ++l) {
    result.levels.push_back(Compare(product, l, lit[l].drive, valid.size()));
    result.chi2 += result.levels.back().chi2;
  }
  const auto freedom = static_cast<double>(lit.size() - 1);
  result.degrees_of_freedom = freedom * static_cast<double>(valid.size() - 1);
  result.p_value = ChiSquareSurvival(result.chi2, result.degrees_of_freedom);
  result.g = Image<float>(lit.front().blocks.size(), kNoValue);
  result.block_p_value = result.g;
  // The levels' luminances are common to all blocks and take a little of each one's freedom.
  const double of_block = freedom * (1 - 1 / static_cast<double>(valid.size()));
  for (size_t b = 0; b < valid.size(); ++b) {
    double chi2 = 0;
    for (size_t l = 0; l < lit.size(); ++l) chi2 += product.Residual2(l, b);
    const double p_value = ChiSquareSurvival(chi2, of_block);
    result.block_p_value.pixels()[valid[b]] = static_cast<float>(p_value);
    result.g.pixels()[valid[b]] = static_cast<float>(product.g(b));
    result.failing_share += p_value < kFails ? 1.0 / static_cast<double>(valid.size()) : 0;
  }
  return result;
}

}  // namespace eyebox::optics
