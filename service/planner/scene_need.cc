#include "service/planner/scene_need.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "absl/strings/str_format.h"

namespace eyebox::service {
namespace {

constexpr double kGreyTolerance = 1e-6;  // of the largest channel

bool IsGrey(const DriveRgb& u) {
  const auto [least, most] = std::minmax({u[0], u[1], u[2]});
  return most - least <= kGreyTolerance * most;
}

DriveRgb ColourOf(const v1::PatchPrediction& patch, SceneNeed& need) {
  DriveRgb colour;
  for (int c = 0; c < 3; ++c) colour[static_cast<size_t>(c)] = patch.u(c);
  const double most = *std::ranges::max_element(colour);
  if (most > 1) {
    need.warnings.push_back(absl::StrFormat(
        "patch %s asks for %.3g times white; it is judged at white", patch.name(), most));
  }
  if (most < kDarkestU) {
    need.warnings.push_back(
        absl::StrFormat("patch %s is darker than %g %% of white; it is judged there", patch.name(),
                        100 * kDarkestU));
  }
  for (double& u : colour) u = std::min(u, 1.0);
  if (most < kDarkestU) colour = {kDarkestU, kDarkestU, kDarkestU};
  return colour;
}

// Whether all of it can be read as it is shown: unlit, and alike in size, as what is read is shown
// at one size.
bool IsFixed(const SceneInput& scene) {
  const bool unlit = std::ranges::all_of(scene.patches, [&](const optics::Patch& patch) {
    return std::holds_alternative<optics::Unlit>(scene.scene.materials[patch.material]);
  });
  const bool alike = std::ranges::all_of(scene.patch_fields, [&](const PatchField& field) {
    return field.diameter_deg == scene.patch_fields.front().diameter_deg;
  });
  return unlit && alike;
}

void TakeColours(const v1::ScenePrediction& prediction, SceneNeed& need) {
  std::vector<DriveRgb> colours;
  for (const v1::PatchPrediction& patch : prediction.patches()) {
    colours.push_back(ColourOf(patch, need));
  }
  need.need.u_from = 1;
  for (const DriveRgb& colour : colours) {
    need.need.u_from = std::min(need.need.u_from, *std::ranges::max_element(colour));
  }
  // A table is certified over a range.
  need.need.u_from = std::min(need.need.u_from, 0.5);
  if (!std::ranges::all_of(colours, IsGrey)) {
    need.need.colours = std::move(colours);
    return;
  }
  for (const DriveRgb& colour : colours) need.need.grey_u.push_back(colour[0]);
}

}  // namespace

SceneNeed NeedOf(const SceneInput& scene, const v1::ScenePrediction& prediction, double field_deg) {
  SceneNeed need;
  TakeColours(prediction, need);
  need.need.fixed = IsFixed(scene);
  need.need.radius_deg = 0;
  for (const PatchField& field : scene.patch_fields) {
    need.anywhere = need.anywhere || !field.within_deg;
    need.need.radius_deg = std::max(need.need.radius_deg, field.within_deg.value_or(field_deg));
    if (!field.diameter_deg) continue;
    // The smallest of them loses most to scatter.
    need.need.disk_deg = need.need.disk_deg == 0
                             ? *field.diameter_deg
                             : std::min(need.need.disk_deg, *field.diameter_deg);
  }
  if (need.need.radius_deg > field_deg) {
    need.warnings.push_back(absl::StrFormat(
        "the scene uses %.3g deg, of which the camera sees %.3g", need.need.radius_deg, field_deg));
    need.need.radius_deg = field_deg;
  }
  return need;
}

}  // namespace eyebox::service
