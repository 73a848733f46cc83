// The colours that a scene's rendered values are to become.
#ifndef EYEBOX_FIT_COLOR_COLOUR_GOAL_H_
#define EYEBOX_FIT_COLOR_COLOUR_GOAL_H_

#include <optional>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "fit/color/colour_model.h"

namespace eyebox::fit {

enum class ColourGamut {
  kNative,  // the display's own primaries and white
  kSrgb,    // ITU-R BT.709 primaries, D65
  kP3,      // SMPTE EG 432-1 primaries, D65
};
std::string_view NameOf(ColourGamut gamut);  // "native", "srgb", "p3"
// Errors: InvalidArgument listing the names.
absl::StatusOr<ColourGamut> ColourGamutOf(std::string_view name);

// What white stands for.
enum class WhiteScale {
  kEveryColour,  // the brightest white at which each rendered colour up to white can be shown
  kWhite,        // the brightest white of all; saturated colours near it are clipped
};
std::string_view NameOf(WhiteScale scale);  // "colours", "white"

struct GoalOptions {
  ColourGamut gamut = ColourGamut::kNative;
  std::optional<Chromaticity> white;  // the gamut's own unless given
  WhiteScale scale = WhiteScale::kEveryColour;
};

struct ColourGoal {
  std::array<Xyz, 3> primaries = {};  // wanted of u / r = (1, 0, 0), (0, 1, 0), (0, 0, 1)
  double share_of_maximum = 1;        // white's luminance over that of drive (1, 1, 1)

  // Proportional to the rendered value: no light of black is added.
  Xyz Wanted(const Rgb& u) const { return Combine(primaries, u); }
  Xyz White() const { return Wanted({1, 1, 1}); }
};

// Errors: InvalidArgument (a white that is no chromaticity, or outside the triangle of primaries);
// FailedPrecondition (no white of that chromaticity can be shown).
absl::StatusOr<ColourGoal> MakeColourGoal(const ColourModel& model, const GoalOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_GOAL_H_
