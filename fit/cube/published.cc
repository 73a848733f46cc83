#include "fit/cube/published.h"

#include <algorithm>
#include <cmath>

#include "fit/cube/goal.h"
#include "fit/cube/minimax.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {

const std::vector<double>& PublishedKnots() {
  static const std::vector<double> knots = {
      -1,      0,       1.657e-9, 0.002830, 0.007137, 0.01269, 0.02051, 0.03086,
      0.04479, 0.06444, 0.08989,  0.1252,   0.1726,   0.2370,  0.3253,  0.4422,
      0.6039,  0.8207,  1.104,    1.495,    2.032,    2.756,   3.738,   5.083,
      6.864,   9.347,   12.62,    17.18,    23.24,    31.48,   42.75,   57.66};
  return knots;
}

std::vector<double> PublishedEntries(const Activation& activation, TableTarget target, int size,
                                     double white_u) {
  if (target != TableTarget::kHdrp) return IdealEntries(activation, target, size, white_u);
  std::vector<double> entries;
  for (double knot_u : PublishedKnots()) {
    const double luminance = WantedLuminance(activation, std::max(knot_u / white_u, 0.0));
    entries.push_back(EntryOfDrive(target, DriveForLuminance(activation, luminance)));
  }
  return entries;
}

}  // namespace eyebox::fit
