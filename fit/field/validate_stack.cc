#include "fit/field/validate_stack.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr char kStack[] = "field stack";
constexpr size_t kFewestLevels = 4;
constexpr double kSmallestRise = 0.01;  // of white

std::string LevelName(size_t level) { return absl::StrCat(kStack, ", level ", level + 1); }

absl::Status ValidateDrives(std::span<const double> drives) {
  for (size_t i = 0; i < drives.size(); ++i) {
    if (!(drives[i] >= 0 && drives[i] <= 1)) {
      return BadInput(LevelName(i), absl::StrCat("drive value ", drives[i], " is outside [0, 1]"),
                      "divide drive values by the display's largest one");
    }
    if (std::find(drives.begin(), drives.begin() + static_cast<std::ptrdiff_t>(i), drives[i]) !=
        drives.begin() + static_cast<std::ptrdiff_t>(i)) {
      return BadInput(LevelName(i), absl::StrCat("drive value ", drives[i], " occurs twice"),
                      "average the repeats of a level");
    }
  }
  return absl::OkStatus();
}

absl::Status NotFinite(size_t level, size_t location, float luminance, const char* remedy) {
  return BadInput(absl::StrCat(LevelName(level), ", location ", location),
                  absl::StrCat("luminance ", luminance, " is not finite"), remedy);
}

absl::Status NameNotFinite(const FieldStack& stack) {
  const size_t locations = stack.LocationCount();
  for (size_t i = 0; i < stack.luminance.size(); ++i) {
    const size_t location = i % locations;
    if (std::isfinite(stack.luminance[i])) continue;
    if (!stack.valid.empty() && stack.valid[location] == 0) continue;
    return NotFinite(i / locations, location, stack.luminance[i], "mark the location as not valid");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status ValidateStack(const FieldStack& stack) {
  EYEBOX_RETURN_IF_ERROR(ValidateDrives(stack.drives));
  const size_t levels = stack.drives.size();
  if (levels < kFewestLevels) {
    return Rejected(kStack, absl::StrCat("it has ", levels, " levels, fewer than ", kFewestLevels),
                    "measure more levels between black and white");
  }
  if (stack.luminance.size() % levels != 0) {
    return BadInput(
        kStack,
        absl::StrCat(stack.luminance.size(), " luminances are no multiple of ", levels, " levels"),
        "give every level the same locations");
  }
  if (!stack.valid.empty() && stack.valid.size() != stack.LocationCount()) {
    return BadInput(kStack,
                    absl::StrCat("its mask has ", stack.valid.size(), " places, its levels have ",
                                 stack.LocationCount()),
                    "give one place per location, or no mask");
  }
  return absl::OkStatus();
}

absl::Status ValidateOptions(const FieldStack& stack, const CommonExponentOptions& options) {
  const size_t levels = stack.drives.size();
  if (!options.level_weights.empty() && options.level_weights.size() != levels) {
    return BadInput(
        "level weights",
        absl::StrCat("there are ", options.level_weights.size(), " for ", levels, " levels"),
        "give one per level, or none");
  }
  for (size_t i = 0; i < options.level_weights.size(); ++i) {
    if (options.level_weights[i] > 0 && std::isfinite(options.level_weights[i])) continue;
    return BadInput(LevelName(i),
                    absl::StrCat("weight ", options.level_weights[i], " is not above 0 and finite"),
                    "leave a level out rather than weight it with 0");
  }
  return ValidateGammaLimits(options.gamma_min, options.gamma_max);
}

absl::Status ValidateGammaLimits(double gamma_min, double gamma_max) {
  if (gamma_min > 0 && gamma_min < gamma_max && std::isfinite(gamma_max)) return absl::OkStatus();
  return BadInput("gamma limits", absl::StrCat(gamma_min, " to ", gamma_max, " is no interval"),
                  "give 0 < gamma_min < gamma_max");
}

absl::Status ValidateMaskedStack(const MaskedStack& stack) {
  EYEBOX_RETURN_IF_ERROR(ValidateStack({stack.drives, stack.luminance, {}}));
  if (stack.LocationCount() == 0) {
    return Rejected(kStack, "it has no location", "check the mask and the exposures");
  }
  if (!stack.valid.empty() && stack.valid.size() != stack.luminance.size()) {
    return BadInput(kStack,
                    absl::StrCat("its mask has ", stack.valid.size(), " places, the stack has ",
                                 stack.luminance.size()),
                    "give one place per level and location, or no mask");
  }
  for (size_t i = 0; i < stack.luminance.size(); ++i) {
    if (std::isfinite(stack.luminance[i])) continue;
    if (!stack.valid.empty() && stack.valid[i] == 0) continue;
    return NotFinite(i / stack.LocationCount(), i % stack.LocationCount(), stack.luminance[i],
                     "mark the reading as not valid");
  }
  return absl::OkStatus();
}

absl::Status ValidateMoments(const FieldStack& stack, const StackMoments& moments) {
  if (moments.locations == 0) {
    return Rejected(kStack, "it has no valid location", "check the mask and the exposures");
  }
  if (!moments.all_finite) return NameNotFinite(stack);
  const auto [lowest, highest] = std::minmax_element(stack.drives.begin(), stack.drives.end());
  const double black = moments.means[lowest - stack.drives.begin()];
  const double white = moments.means[highest - stack.drives.begin()];
  if (white > 0 && white - black >= kSmallestRise * white) return absl::OkStatus();
  return Rejected(kStack,
                  absl::StrCat("its mean luminance does not rise with the drive value: ", black,
                               " at the lowest, ", white, " at the highest"),
                  "check that the display showed the levels and that the camera saw them");
}

}  // namespace eyebox::fit
