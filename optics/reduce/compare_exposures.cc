#include "optics/reduce/compare_exposures.h"

#include <cmath>
#include <limits>

namespace eyebox::optics {
namespace {

struct PairSums {
  double shorter = 0;
  double longer = 0;
  double shorter_variance = 0;
  double longer_variance = 0;
  size_t pixels = 0;
};

PairSums SumPair(const MeasuredImage& shorter, const MeasuredImage& longer,
                 const Image<float>& expected_rate_dn_s) {
  PairSums sums;
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
  return sums;
}

}  // namespace

ExposurePairCheck CompareExposures(const MeasuredImage& shorter, double shorter_s,
                                   const MeasuredImage& longer, double longer_s,
                                   const Image<float>& expected_rate_dn_s) {
  const PairSums sums = SumPair(shorter, longer, expected_rate_dn_s);
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
