#include "fit/field/mask_groups.h"

#include <map>
#include <string>
#include <utility>

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
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace eyebox::fit
