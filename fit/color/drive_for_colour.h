// The drive values that show a colour: the forward model undone, interaction included.
#ifndef EYEBOX_FIT_COLOR_DRIVE_FOR_COLOUR_H_
#define EYEBOX_FIT_COLOR_DRIVE_FOR_COLOUR_H_

#include "fit/color/colour_model.h"

namespace eyebox::fit {

struct ColourDrive {
  Rgb drive = {};  // not negative; above 1 where the display is not bright enough
  // False where a channel would have to be darker than it is at drive 0. Then the colour shown has
  // the wanted luminance, as far as black allows, and is less saturated: all other channels give up
  // the same activation.
  bool saturation_reached = true;
  // False if that is so even without the light of black: the chromaticity lies outside the
  // display's gamut, not merely in the shadow of its black.
  bool inside_gamut = true;
};

// `model` must be valid. The colour shown agrees with a `wanted` that can be reached to 1e-9 of the
// sum of its activations.
ColourDrive DriveForColour(const ColourModel& model, const Xyz& wanted);

// What a display of these primaries without any light of black would show of `wanted`: the same
// luminance, and less saturated where `wanted` lies outside the gamut.
Xyz NearestInGamut(const ColourModel& model, const Xyz& wanted);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_DRIVE_FOR_COLOUR_H_
