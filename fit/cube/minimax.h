// The monotone entries with the smallest possible worst relative luminance error.
#ifndef EYEBOX_FIT_CUBE_MINIMAX_H_
#define EYEBOX_FIT_CUBE_MINIMAX_H_

#include <vector>

#include "fit/base/activation.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

// A rendered value at which the design is held to its error.
struct DesignPoint {
  double x = 0;       // u / r
  int interval = 0;   // between entries `interval` and `interval + 1`
  double weight = 0;  // of the upper entry
  double wanted = 0;  // luminance
};

// Ascending points over x in [x_from, 1], dense in the table's axis and in log x.
std::vector<DesignPoint> DesignPoints(const Activation& activation, TableTarget target, int size,
                                      double white_u, double x_from);

// f at each knot (HDRP model, eq 15), continued beyond white; what is published samples this.
std::vector<double> IdealEntries(const Activation& activation, TableTarget target, int size,
                                 double white_u);

// [size] real numbers. The worst error over `points` is within 1e-4 of the smallest possible one,
// by bisection on it. Entries below the points follow the ideal curve as far as monotony allows;
// those above hold the display at white. Entries above white's exceed it only for kHdrp and
// kResolve, whose files can hold them.
std::vector<double> MinimaxEntries(const Activation& activation, TableTarget target, int size,
                                   double white_u, const std::vector<DesignPoint>& points);

// How large the design may make an entry whose ideal value is `ideal`.
double LargestEntry(TableTarget target, double ideal);

// Puts `designed` in at `first`; what lies below never exceeds it, what lies above holds white.
void InsertDesigned(const std::vector<double>& designed, size_t first, TableTarget target,
                    std::vector<double>& entries);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_MINIMAX_H_
