#include "optics/reduce/compare_exposures.h"

#include <cmath>
#include <limits>

namespace eyebox::optics {

void AddPair(const MeasuredImage& shorter, const MeasuredImage& longer,
             const Image<float>& expected_rate_dn_s, PairSums& sums) {
  const auto expected = expected_rate_dn_s.pixels();
  for (size_t i = 0; i < expected.size(); ++i) {
    if ((shorter.mask.pixels()[i] | longer.mask.pixels()[i]) != 0) continue;
    ++sums.pixels;
    if (!(expected[i] > 0)) continue;
    const double shorter_variance = shorter.variance.pixels()[i];
    const double longer_variance = longer.variance.pixels()[i];
    const double weight = expected[i] / (shorter_variance + longer_variance);
    sums.shorter += weight * shorter.value.pixels()[i];
    sums.longer += weight * longer.value.pixels()[i];
    sums.shorter_variance += weight * weight * shorter_variance;
    sums.longer_variance += weight * weight * longer_variance;
  }
}

ExposurePairCheck CompareExposures(const MeasuredImage& shorter, double shorter_s,
                                   const MeasuredImage& longer, double longer_s,
                                   const Image<float>& expected_rate_dn_s) {
  PairSums sums;
  AddPair(shorter, longer, expected_rate_dn_s, sums);
  return CompareExposures(sums, shorter_s, longer_s);
}

ExposurePairCheck CompareExposures(const PairSums& sums, double shorter_s, double longer_s) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ExposurePairCheck check{shorter_s, longer_s, kNone, kNone, sums.pixels};
  if (!(sums.shorter > 3 * std::sqrt(sums.shorter_variance))) return check;
  check.ratio = sums.longer / sums.shorter;
  check.sigma =
      std::sqrt(sums.longer_variance + check.ratio * check.ratio * sums.shorter_variance) /
      sums.shorter;
  return check;
}

}  // namespace eyebox::optics
