// The smallest error that a chain of entries can be held to.
#ifndef EYEBOX_FIT_CUBE_BISECTION_H_
#define EYEBOX_FIT_CUBE_BISECTION_H_

#include <optional>
#include <utility>
#include <vector>

namespace eyebox::fit {

// `chain` gives Preferred(), entries to start from; WorstError(entries); and Within(error), entries
// whose error is not larger, or nothing. The error is within 1e-4 of the smallest possible one.
template <typename Chain>
std::vector<double> SmallestWorstError(Chain& chain) {
  constexpr double kResolution = 1e-4;  // relative
  constexpr double kNotWorthReducing = 1e-9;
  std::vector<double> best = chain.Preferred();
  double reached = chain.WorstError(best);
  double out_of_reach = 0;
  while (reached > kNotWorthReducing && reached - out_of_reach > kResolution * reached) {
    const double middle = out_of_reach + (reached - out_of_reach) / 2;
    if (std::optional<std::vector<double>> entries = chain.Within(middle)) {
      best = *std::move(entries);
      reached = middle;
    } else {
      out_of_reach = middle;
    }
  }
  return best;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_BISECTION_H_
