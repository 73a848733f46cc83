// Where relative errors stop being relative.
#ifndef EYEBOX_FIT_BASE_RELATIVE_FLOOR_H_
#define EYEBOX_FIT_BASE_RELATIVE_FLOOR_H_

namespace eyebox::fit {

// Relative errors are taken of at least this share of the brightest level: below it a display is
// black, and instruments disagree.
constexpr double kRelativeFloor = 1e-3;

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_RELATIVE_FLOOR_H_
