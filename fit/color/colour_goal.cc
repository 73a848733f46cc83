#include "fit/color/colour_goal.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/color/drive_for_colour.h"

namespace eyebox::fit {
namespace {

constexpr Chromaticity kD65 = {0.3127, 0.3290};
constexpr std::array<Chromaticity, 3> kBt709 = {{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}}};
constexpr std::array<Chromaticity, 3> kDisplayP3 = {
    {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}};
constexpr ColourGamut kGamuts[] = {ColourGamut::kNative, ColourGamut::kSrgb, ColourGamut::kP3};
constexpr int kBisections = 60;
constexpr double kBrightestSought = 4;  // times the display's white
constexpr double kRounding = 1e-12;

std::array<Xyz, 3> PrimariesOf(const ColourModel& model, ColourGamut gamut) {
  if (gamut == ColourGamut::kNative) return model.primaries;
  std::array<Xyz, 3> primaries;
  for (size_t k = 0; k < 3; ++k) {
    primaries[k] = ColourOf(gamut == ColourGamut::kSrgb ? kBt709[k] : kDisplayP3[k], 1);
  }
  return primaries;
}

Chromaticity WhiteOf(const ColourModel& model, const GoalOptions& options) {
  if (options.white) return *options.white;
  if (options.gamut != ColourGamut::kNative) return kD65;
  return ChromaticityOf(model.Colour({1, 1, 1}));
}

ColourGoal Scaled(const ColourGoal& unit, double luminance) {
  ColourGoal goal = unit;
  for (Xyz& primary : goal.primaries) {
    for (double& component : primary) component *= luminance;
  }
  return goal;
}

bool CanShow(const ColourModel& model, const ColourGoal& goal, WhiteScale scale) {
  for (int corner = scale == WhiteScale::kWhite ? 7 : 1; corner < 8; ++corner) {
    const Rgb u = {corner & 1 ? 1.0 : 0.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 1.0 : 0.0};
    const Rgb drive = DriveForColour(model, goal.Wanted(u)).drive;
    if (*std::ranges::max_element(drive) > 1 + kRounding) return false;
  }
  return true;
}

absl::Status CheckWhite(const Chromaticity& white) {
  if (white.x > 0 && white.y > 0 && white.x + white.y < 1) return absl::OkStatus();
  return BadInput("white point",
                  absl::StrCat("x ", white.x, ", y ", white.y, " is no chromaticity"),
                  "give x and y above 0 with x + y below 1, for example 0.3127,0.3290");
}

}  // namespace

std::string_view NameOf(ColourGamut gamut) {
  if (gamut == ColourGamut::kNative) return "native";
  return gamut == ColourGamut::kSrgb ? "srgb" : "p3";
}

absl::StatusOr<ColourGamut> ColourGamutOf(std::string_view name) {
  for (ColourGamut gamut : kGamuts) {
    if (NameOf(gamut) == name) return gamut;
  }
  return BadInput("gamut", absl::StrCat("there is no gamut '", std::string(name), "'"),
                  "give native, srgb or p3");
}

std::string_view NameOf(WhiteScale scale) {
  return scale == WhiteScale::kEveryColour ? "colours" : "white";
}

absl::StatusOr<ColourGoal> MakeColourGoal(const ColourModel& model, const GoalOptions& options) {
  const Chromaticity white = WhiteOf(model, options);
  EYEBOX_RETURN_IF_ERROR(CheckWhite(white));
  ColourGoal unit;
  unit.primaries = PrimariesOf(model, options.gamut);
  const Rgb shares = WeightsFor(unit.primaries, ColourOf(white, 1));
  for (size_t k = 0; k < 3; ++k) {
    if (!(shares[k] > 0)) {
      return BadInput("white point",
                      absl::StrCat("x ", white.x, ", y ", white.y,
                                   " lies outside the triangle of the primaries"),
                      "choose another white point or gamut");
    }
    for (double& component : unit.primaries[k]) component *= shares[k];
  }
  const double brightest = model.Colour({1, 1, 1})[1];
  double shown = 0;
  double not_shown = kBrightestSought;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (shown + not_shown) / 2;
    (CanShow(model, Scaled(unit, middle * brightest), options.scale) ? shown : not_shown) = middle;
  }
  if (!(shown * brightest > model.background[1])) {
    return Rejected("white point", "the display cannot show it brighter than its black",
                    "choose another white point or gamut");
  }
  ColourGoal goal = Scaled(unit, shown * brightest);
  goal.share_of_maximum = shown;
  return goal;
}

}  // namespace eyebox::fit
