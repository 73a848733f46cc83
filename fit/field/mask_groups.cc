#include "fit/field/mask_groups.h"

#include <Eigen/QR>
#include <cmath>
#include <map>
#include <string>

namespace eyebox::fit {
namespace {

constexpr size_t kFewestLevels = 3;  // two are met by every exponent

std::string MaskOf(const MaskedStack& stack, size_t location) {
  std::string mask(stack.drives.size(), '\1');
  if (stack.valid.empty()) return mask;
  const size_t locations = stack.LocationCount();
  for (size_t level = 0; level < mask.size(); ++level) {
    mask[level] = stack.valid[level * locations + location] != 0 ? '\1' : '\0';
  }
  return mask;
}

Eigen::MatrixXd RowsOf(const MaskedStack& stack, const FieldWeights& weights,
                       const MaskGroup& group) {
  Eigen::MatrixXd rows(group.members.size(), group.levels.size());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const size_t location = group.members[i];
    const double root_weight = std::sqrt(weights.locations[location]);
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      const size_t place = group.levels[k] * stack.LocationCount() + location;
      rows(i, k) = root_weight * group.root_weights[k] * stack.luminance[place];
    }
  }
  return rows;
}

void FillRows(const MaskedStack& stack, const FieldWeights& weights, MaskGroup& group) {
  const auto levels = static_cast<Eigen::Index>(group.levels.size());
  group.root_weights.resize(levels);
  for (Eigen::Index k = 0; k < levels; ++k) {
    group.root_weights[k] = std::sqrt(weights.levels[group.levels[k]]);
  }
  group.constant = group.root_weights.normalized();
  Eigen::MatrixXd rows = RowsOf(stack, weights, group);
  rows -= (rows * group.constant) * group.constant.transpose();
  if (rows.rows() > levels) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
    rows = qr.matrixQR().topRows(levels).triangularView<Eigen::Upper>();
  }
  group.rows = rows;
  group.squares = rows.squaredNorm();
}

}  // namespace

std::vector<MaskGroup> GroupByMask(const MaskedStack& stack, const FieldWeights& weights) {
  std::map<std::string, std::vector<size_t>> members;
  for (size_t location = 0; location < stack.LocationCount(); ++location) {
    if (weights.locations[location] > 0) members[MaskOf(stack, location)].push_back(location);
  }
  std::vector<MaskGroup> groups;
  for (auto& [mask, locations] : members) {
    MaskGroup group;
    for (size_t level = 0; level < mask.size(); ++level) {
      if (mask[level] != 0) group.levels.push_back(static_cast<int>(level));
    }
    if (group.levels.size() < kFewestLevels) continue;
    group.members = std::move(locations);
    FillRows(stack, weights, group);
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace eyebox::fit
