// The internal table through which HDRP's post-process sends every colour, also when tonemapping is
// off: one entry a point of a grid in LogC, made by decoding the point, grading it, applying the
// External table if there is one, and storing the result.
#ifndef EYEBOX_OPTICS_RENDER_GRADING_TABLE_H_
#define EYEBOX_OPTICS_RENDER_GRADING_TABLE_H_

#include "optics/render/colour_table.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

struct GradingOptions {
  // Neutral grading still turns each colour to hue, saturation and value and back, guarded against
  // division by zero with 1e-4: the darkest channel rises by about 1e-4 (1 - darkest / brightest).
  bool through_hsv = true;
  bool half_floats = true;  // entries of the external and of the internal table, else exact
};

// `external` may be null: tonemapping None. Else its axis is LogC too, its size any; the internal
// table has `size`, 2 to 129, the project's grading table size.
ColourTable GradingTable(int size, const ColourTable* external, const GradingOptions& options = {});

// RGB to HSV and back with `guard` added to both divisors. A grey keeps its value; the brightest
// channel always does. Of colours that are not negative.
Rgb ThroughHsv(const Rgb& colour, double guard);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_GRADING_TABLE_H_
