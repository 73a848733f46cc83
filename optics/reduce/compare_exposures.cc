#include "optics/reduce/compare_exposures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capture/base/vectorise.h"

namespace eyebox::optics {
namespace {

constexpr size_t kLanes = 8;
constexpr size_t kChunk = 64 * kLanes;  // so many products wait in the first-level cache

// What is summed, of some pixels; nothing where one of the two is invalid or no light is expected.
struct Products {
  float shorter[kChunk];
  float longer[kChunk];
  float shorter_variance[kChunk];
  float longer_variance[kChunk];
};

// Single precision: a weight's rounding is the same in all four sums.
EYEBOX_VECTORISE
void Multiply(const ConstMeasuredRow& shorter, const ConstMeasuredRow& longer,
              const float* expected, size_t first, size_t count, Products* __restrict__ products) {
  const float* const shorter_value = shorter.value.data() + first;
  const float* const longer_value = longer.value.data() + first;
  const float* const shorter_variance = shorter.variance.data() + first;
  const float* const longer_variance = longer.variance.data() + first;
  const uint8_t* const shorter_mask = shorter.mask.data() + first;
  const uint8_t* const longer_mask = longer.mask.data() + first;
  const float* const light = expected + first;
  for (size_t i = 0; i < count; ++i) {
    const bool counts = ((shorter_mask[i] | longer_mask[i]) == 0) & (light[i] > 0);
    const float weight = light[i] / (shorter_variance[i] + longer_variance[i]);
    products->shorter[i] = counts ? weight * shorter_value[i] : 0.0F;
    products->longer[i] = counts ? weight * longer_value[i] : 0.0F;
    products->shorter_variance[i] = counts ? weight * weight * shorter_variance[i] : 0.0F;
    products->longer_variance[i] = counts ? weight * weight * longer_variance[i] : 0.0F;
  }
}

// Every kLanes-th by itself, so that as many are added at once.
EYEBOX_VECTORISE
double Sum(const float* terms, size_t count) {
  double lanes[kLanes] = {};
  const size_t whole = count / kLanes * kLanes;
  for (size_t i = 0; i < whole; i += kLanes) {
    for (size_t lane = 0; lane < kLanes; ++lane)
      lanes[lane] += static_cast<double>(terms[i + lane]);
  }
  double sum = 0;
  for (const double lane : lanes) sum += lane;
  for (size_t i = whole; i < count; ++i) sum += static_cast<double>(terms[i]);
  return sum;
}

size_t CountBothValid(std::span<const uint8_t> one, std::span<const uint8_t> other) {
  size_t count = 0;
  for (size_t i = 0; i < one.size(); ++i) count += (one[i] | other[i]) == 0 ? 1 : 0;
  return count;
}

}  // namespace

void AddPair(const ConstMeasuredRow& shorter, const ConstMeasuredRow& longer,
             std::span<const float> expected_rate_dn_s, PairSums& sums) {
  Products products;
  sums.pixels += CountBothValid(shorter.mask, longer.mask);
  for (size_t first = 0; first < shorter.size(); first += kChunk) {
    const size_t count = std::min(kChunk, shorter.size() - first);
    Multiply(shorter, longer, expected_rate_dn_s.data(), first, count, &products);
    sums.shorter += Sum(products.shorter, count);
    sums.longer += Sum(products.longer, count);
    sums.shorter_variance += Sum(products.shorter_variance, count);
    sums.longer_variance += Sum(products.longer_variance, count);
  }
}

ExposurePairCheck CompareExposures(const MeasuredImage& shorter, double shorter_s,
                                   const MeasuredImage& longer, double longer_s,
                                   const Image<float>& expected_rate_dn_s) {
  PairSums sums;
  AddPair(PixelsOf(shorter), PixelsOf(longer), expected_rate_dn_s.pixels(), sums);
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
