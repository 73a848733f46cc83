// Where w ends, from readings that contradict a w that ends far outside of them.
#ifndef EYEBOX_FIT_SCATTER_FIND_REACH_H_
#define EYEBOX_FIT_SCATTER_FIND_REACH_H_

#include <functional>

#include "absl/status/statusor.h"
#include "fit/scatter/fit_scatter.h"

namespace eyebox::fit {

// A fit with this reach held, from the parameters of another.
using FitAtReach =
    std::function<absl::StatusOr<ScatterFit>(double reach_deg, const ScatterFit& start)>;

// From a fit that the readings contradict to the reach with the least chi-square below its own, if
// one is more likely by 3 standard deviations; else the same fit comes back, its reach held. The
// standard uncertainty of the reach, from the curvature of chi-square there, enters the covariance
// of all parameters. A reach that no fit converges with ends the search downwards. Errors: those of
// `fit_at` close to the least.
absl::StatusOr<ScatterFit> FindReach(const ScatterFit& widest, const FitAtReach& fit_at);

// The same from a fit of nearly the same readings, whose reach was found.
absl::StatusOr<ScatterFit> RefineReach(const ScatterFit& near, const FitAtReach& fit_at);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_SCATTER_FIND_REACH_H_
