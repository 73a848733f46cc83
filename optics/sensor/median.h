// The median, by partial sorting.
#ifndef EYEBOX_OPTICS_SENSOR_MEDIAN_H_
#define EYEBOX_OPTICS_SENSOR_MEDIAN_H_

#include <algorithm>
#include <limits>
#include <vector>

namespace eyebox::optics {

// Mean of the two middle values where their number is even; NaN of nothing. No value may be NaN.
inline double Median(std::vector<float> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (static_cast<double>(*middle) + *std::max_element(values.begin(), middle));
}

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_MEDIAN_H_
