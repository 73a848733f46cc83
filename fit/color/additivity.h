// Whether a display's colours add up, and whether each channel keeps its chromaticity: what the
// additive model assumes, tested on the readings themselves.
#ifndef EYEBOX_FIT_COLOR_ADDITIVITY_H_
#define EYEBOX_FIT_COLOR_ADDITIVITY_H_

#include <string>
#include <vector>

#include "fit/color/colour_series.h"

namespace eyebox::fit {

struct AdditivityLevel {
  double drive = 0;
  // (sum of the three primaries - 2 black) / white - 1 in X, Y, Z, all of them as measured.
  Xyz departure = {};
  // False where white is too close to black for it to mean anything; not in the figures below.
  std::array<bool, 3> counts = {};
};

struct AdditivityTest {
  std::vector<AdditivityLevel> levels;  // where grey, the three primaries and black were measured
  Xyz mean_departure = {};
  Xyz standard_error = {};  // of the mean, from the scatter between levels
  Xyz rms_departure = {};
  double max_departure = 0;  // the largest in size, with its sign
  double at_drive = 0;
  bool tested = false;  // false: no component had two levels to compare
  bool passed = false;  // each |mean| <= max(tolerance, 3 standard errors)
  std::string verdict;  // in words, with figures
};

// Levels count where white's component exceeds black's by `floor` of the largest component.
AdditivityTest TestAdditivity(const ColourSeries& series, double tolerance = 0.01,
                              double floor = 0.01);

struct ConstancyLevel {
  double drive = 0;
  double chromaticity_distance = 0;  // u'v', of the light above black, from that at the top level
  bool counts = false;               // bright enough for its chromaticity to mean anything
};

struct ConstancyTest {
  std::vector<ConstancyLevel> levels;  // ascending drive, the channel alone
  double max_distance = 0;
  double at_drive = 0;
  double rms_distance = 0;
  bool tested = false;
  bool passed = false;  // rms_distance <= tolerance: a single noisy level does not decide
};

// [3]. Levels count where the channel's luminance above black exceeds `floor` of its largest.
// Nothing is tested without a reading of black or with fewer than two levels that count.
std::array<ConstancyTest, 3> TestConstancy(const ColourSeries& series, double tolerance = 0.01,
                                           double floor = 0.02);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_ADDITIVITY_H_
