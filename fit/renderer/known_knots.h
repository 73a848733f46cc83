// Where the knots of HDRP's External table lie, as published and as LogC says.
#ifndef EYEBOX_FIT_RENDERER_KNOWN_KNOTS_H_
#define EYEBOX_FIT_RENDERER_KNOWN_KNOTS_H_

#include <array>
#include <vector>

namespace eyebox::fit {

inline constexpr int kPublishedSize = 32;
// Published from the third on: [30], u* of entries 3 to 32 (HDRP model, table 2).
using PublishedKnots = std::array<double, 30>;
const PublishedKnots& KnotsFromDeltas();  // table 2(a)
// Table 2(b); its seventh value is printed as 0.4479, which would not be monotone: 0.04479.
const PublishedKnots& KnotsFromOptimisation();

// The u at which entry i of `size` lies: LogCToLinear(i / (size - 1)), below 0 for the first two of
// 32.
std::vector<double> AnalyticKnots(int size);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_RENDERER_KNOWN_KNOTS_H_
