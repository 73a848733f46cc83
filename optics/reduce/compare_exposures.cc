#include "optics/reduce/compare_exposures.h"

#include <array>
#include <cmath>
#include <limits>

#include "capture/base/vectorise.h"

namespace eyebox::optics {

namespace {

constexpr size_t kLanes = 8;

// Sums of every kLanes-th pixel, so that as many are added at once.
struct LaneSums {
  std::array<double, kLanes> shorter = {}, longer = {}, shorter_variance = {}, longer_variance = {};
  std::array<size_t, kLanes> pixels = {};
};

// The first kLanes * groups pixels.
EYEBOX_VECTORISE
void AddGroups(const MeasuredImage& shorter, const MeasuredImage& longer, const float* expected,
               size_t groups, LaneSums& sums) {
  const float* const shorter_value = shorter.value.pixels().data();
  const float* const longer_value = longer.value.pixels().data();
  const float* const shorter_variance = shorter.variance.pixels().data();
  const float* const longer_variance = longer.variance.pixels().data();
  const uint8_t* const shorter_mask = shorter.mask.pixels().data();
  const uint8_t* const longer_mask = longer.mask.pixels().data();
  LaneSums own = sums;
  for (size_t i = 0; i < groups * kLanes; i += kLanes) {
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const size_t k = i + lane;
      const bool valid = (shorter_mask[k] | longer_mask[k]) == 0;
      const bool counts = valid & (expected[k] > 0);
      const double a = counts ? shorter_variance[k] : 1.0F;
      const double b = counts ? longer_variance[k] : 1.0F;
      const double weight = (counts ? expected[k] : 0.0F) / (a + b);
      own.pixels[lane] += valid ? 1 : 0;
      own.shorter[lane] += weight * (counts ? shorter_value[k] : 0.0F);
      own.longer[lane] += weight * (counts ? longer_value[k] : 0.0F);
      own.shorter_variance[lane] += weight * weight * a;
      own.longer_variance[lane] += weight * weight * b;
    }
  }
  sums = own;
}

}  // namespace

void AddPair(const MeasuredImage& shorter, const MeasuredImage& longer,
             const Image<float>& expected_rate_dn_s, PairSums& sums) {
  const auto expected = expected_rate_dn_s.pixels();
  const size_t whole = expected.size() / kLanes;
  LaneSums lanes;
  AddGroups(shorter, longer, expected.data(), whole, lanes);
  for (size_t i = whole * kLanes; i < expected.size(); ++i) {
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
  for (size_t lane = 0; lane < kLanes; ++lane) {
    sums.pixels += lanes.pixels[lane];
    sums.shorter += lanes.shorter[lane];
    sums.longer += lanes.longer[lane];
    sums.shorter_variance += lanes.shorter_variance[lane];
    sums.longer_variance += lanes.longer_variance[lane];
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
