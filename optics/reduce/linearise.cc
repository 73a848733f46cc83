#include "optics/reduce/linearise.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kLeastRatioOfPair = 1.5;

bool HasSignal(const ResponsePoint& point) { return point.irradiation > 0 && point.signal_dn > 0; }

LinearityPair PairOf(const ResponsePoint& shorter, const ResponsePoint& longer) {
  return {shorter.signal_dn, longer.signal_dn, longer.irradiation / shorter.irradiation,
          shorter.variance_dn2, longer.variance_dn2};
}

}  // namespace

LinearityCurve::Corrected LinearityCurve::At(double measured_dn) const {
  const size_t last = knots_dn.size() - 1;
  if (measured_dn >= knots_dn[last]) {
    const double factor = corrected_dn[last] / knots_dn[last];
    const double growth = measured_dn / knots_dn[last];
    return {measured_dn * factor, factor, variance_dn2[last] * growth * growth};
  }
  // Below the first knot above 0, and for negative counts, the line through 0.
  const auto above = std::upper_bound(knots_dn.begin() + 1, knots_dn.end() - 1, measured_dn);
  const auto k = static_cast<size_t>(above - knots_dn.begin());
  const double run = knots_dn[k] - knots_dn[k - 1];
  const double part = (measured_dn - knots_dn[k - 1]) / run;
  const double slope = (corrected_dn[k] - corrected_dn[k - 1]) / run;
  const double value = corrected_dn[k - 1] + slope * (measured_dn - knots_dn[k - 1]);
  if (k == 1) return {value, slope, variance_dn2[1] * part * part};
  return {value, slope, variance_dn2[k - 1] + part * (variance_dn2[k] - variance_dn2[k - 1])};
}

double LinearityCurve::LargestRelativeCorrection() const {
  double largest = 0;
  for (size_t k = 1; k < knots_dn.size(); ++k) {
    largest = std::max(largest, std::abs(corrected_dn[k] / knots_dn[k] - 1));
  }
  return largest;
}

std::vector<LinearityPair> PairsOfSeries(std::span<const ResponsePoint> points) {
  std::vector<LinearityPair> pairs;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!HasSignal(points[i])) continue;
    for (size_t k = i + 1; k < points.size(); ++k) {
      if (points[k].irradiation < kLeastRatioOfPair * points[i].irradiation) continue;
      if (!HasSignal(points[k])) break;
      pairs.push_back(PairOf(points[i], points[k]));
      if (k + 1 < points.size() && HasSignal(points.back())) {
        pairs.push_back(PairOf(points[i], points.back()));
      }
      break;
    }
  }
  return pairs;
}

void LinearisePixels(const LinearityCurve& curve, const MeasuredRow& counts_dn) {
  for (size_t i = 0; i < counts_dn.size(); ++i) {
    if (counts_dn.mask[i] != 0) continue;
    const LinearityCurve::Corrected corrected = curve.At(counts_dn.value[i]);
    counts_dn.value[i] = static_cast<float>(corrected.value_dn);
    counts_dn.variance[i] = static_cast<float>(
        counts_dn.variance[i] * corrected.slope * corrected.slope + corrected.variance_dn2);
  }
}

absl::StatusOr<MeasuredImage> Linearise(MeasuredImage image_dn, const LinearityCurve& curve) {
  if (image_dn.unit != "DN") {
    return BadInput("image", absl::StrCat("its unit is ", image_dn.unit),
                    "linearise counts in DN, before they are divided by anything");
  }
  LinearisePixels(curve, PixelsOf(image_dn));
  image_dn.history.push_back(absl::StrCat("Linearise(", curve.knots_dn.size(), " knots from ",
                                          curve.from_dn, " to ", curve.to_dn, " DN, at most ",
                                          100 * curve.LargestRelativeCorrection(), " %)"));
  return image_dn;
}

}  // namespace eyebox::optics
