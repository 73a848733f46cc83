// A row of unknown entries a_0 <= a_1 <= ... of which each neighbouring pair is held to bounds on
// its linear interpolation: a chain of linear programs in two variables.
#ifndef EYEBOX_FIT_CUBE_CHAIN_H_
#define EYEBOX_FIT_CUBE_CHAIN_H_

#include <optional>
#include <span>
#include <vector>

namespace eyebox::fit {

// low <= (1 - weight) a_i + weight a_(i+1) <= high; high may be infinite.
struct MixBound {
  double weight = 0;  // of the upper entry, in [0, 1]
  double low = 0;
  double high = 0;
};

struct ChainProblem {
  std::vector<std::vector<MixBound>> intervals;  // [entries - 1]
  std::vector<double> cap;                       // [entries], 0 <= a_i <= cap_i
  std::vector<double> preferred;                 // [entries], taken as closely as the bounds allow
};

// Exact up to rounding: the feasible range of each entry is carried forward through the polygon of
// each interval, then entries are chosen backwards. Nothing if no monotone row meets the bounds.
std::optional<std::vector<double>> SolveChain(const ChainProblem& problem);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_CHAIN_H_
