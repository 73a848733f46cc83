// Which exposures and which grey the ladder climbs.
#ifndef EYEBOX_SERVICE_PREFLIGHT_LADDER_RANGE_H_
#define EYEBOX_SERVICE_PREFLIGHT_LADDER_RANGE_H_

#include <array>

#include "absl/status/statusor.h"
#include "service/preflight/frame_taker.h"

namespace eyebox::service {

// Exposures 1, 2, 4, ... times the first: 1.5 decades.
constexpr size_t kLadderRungs = 6;

struct LadderRange {
  double drive = 1;  // of the grey full field, which is left on
  std::array<double, kLadderRungs> exposures_s = {};
  double Shortest() const { return exposures_s.front(); }
  double Longest() const { return exposures_s.back(); }
};

// The brightest of some greys whose longest unsaturated exposure leaves room for the ladder below.
// `period_s` is that of a flashing display, of which every exposure is then a whole number; 0 if it
// is steady or not known. Where even the darkest grey is too bright, the ladder of that one comes
// back, and its rungs will be saturated.
// Errors: those of FrameTaker.
absl::StatusOr<LadderRange> ChooseLadder(FrameTaker& taker, double period_s, double longest_s);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_LADDER_RANGE_H_
