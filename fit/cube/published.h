// The tables that the literature makes, for comparison.
#ifndef EYEBOX_FIT_CUBE_PUBLISHED_H_
#define EYEBOX_FIT_CUBE_PUBLISHED_H_

#include <vector>

#include "fit/base/activation.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

// Entries of the only size for which HDRP's knots were published.
constexpr int kPublishedSize = 32;

// Murray, HDRP model, table 2(b), [32]: the knots u* that predicted renderings best. The eighth is
// misprinted there (0.4479); it must be 0.04479 for the knots to rise. The first two play no part.
const std::vector<double>& PublishedKnots();

// f (eq 15) at each knot: the published ones for kHdrp with 32 entries, else the target's own.
// Continued above white, so that the interval that holds white is not bent.
std::vector<double> PublishedEntries(const Activation& activation, TableTarget target, int size,
                                     double white_u);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_PUBLISHED_H_
