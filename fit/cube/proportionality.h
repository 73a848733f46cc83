// How far luminance that was measured through a table is from proportional to what was rendered.
#ifndef EYEBOX_FIT_CUBE_PROPORTIONALITY_H_
#define EYEBOX_FIT_CUBE_PROPORTIONALITY_H_

#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace eyebox::fit {

struct RenderedReading {
  std::vector<double> rendered;  // u: one number (grey), or red, green, blue
  double luminance = 0;
  double luminance_sigma = 0;  // standard uncertainty, 0 where not known
};

struct LineDeparture {
  double line = 0;                        // luminance of the line
  double departure_of_value = 0;          // luminance / line - 1; 0 where the line is 0
  double departure_of_maximum = 0;        // (luminance - line) / largest luminance
  double departure_of_maximum_sigma = 0;  // from all the luminance_sigma, the line's share included
};

struct LineThroughOrigin {
  std::vector<double> slopes;  // [inputs], luminance per rendered value
  std::vector<double> slope_sigmas;
  std::vector<LineDeparture> departures;  // as the readings
  double worst_of_maximum = 0;            // largest |departure_of_maximum|
  double worst_of_maximum_sigma = 0;
  double worst_of_value = 0;  // largest |departure_of_value| where something was rendered
  double rms_of_maximum = 0;
};

// Luminance = sum of slope_k u_k by least squares without weights: the straight line through the
// origin of Murray's HDRP model, fig 8, which treats a photometer's errors as a share of its range.
// Errors: InvalidArgument naming `source` (no readings, readings of different length, numbers that
// are not finite), FailedPrecondition (fewer readings than inputs plus one, an input that is never
// rendered apart from the others, no light).
absl::StatusOr<LineThroughOrigin> FitLineThroughOrigin(std::span<const RenderedReading> readings,
                                                       const std::string& source);

// One reading that a certificate speaks of: x > 0, luminance / x should be the same for all.
struct JudgedReading {
  double x = 0;
  double luminance = 0;
  double luminance_sigma = 0;
  double allowed = 0;  // largest |L / L_wanted - 1|, below 1
};

struct Judgement {
  bool passes = false;
  // The smallest error at which one line fits every reading, noise and allowance left aside.
  double proportionality_error = 0;
  double coverage_factor = 0;  // how many sigmas each reading was given
  size_t lowest = 0;           // readings that part the furthest: luminance / x too small
  size_t highest = 0;          // and too large
};

// Passes if there is one line through the origin from which every reading departs by no more than
// it is allowed, give or take its noise. The line's slope is free, so that a photometer's scale
// does not matter. A table that keeps its certificate fails with a probability of at most 1 % over
// all `family` comparisons (Bonferroni, normal noise). At least one reading.
Judgement JudgeProportional(std::span<const JudgedReading> readings, size_t family);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_PROPORTIONALITY_H_
