#include "optics/sensor/defect_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr double kMadToSigma = 1.4826;  // of a normal distribution
const double kQuantisationSigmaDn = std::sqrt(1.0 / 12);

// Marks what lies above median + threshold * robust sigma; returns the median.
double MarkOutliers(const std::vector<float>& values_dn, double threshold,
                    std::span<uint8_t> defective) {
  const double median = Median(values_dn);
  std::vector<float> deviations(values_dn.size());
  std::transform(values_dn.begin(), values_dn.end(), deviations.begin(),
                 [median](float v) { return std::abs(v - static_cast<float>(median)); });
  const double sigma = std::max(kMadToSigma * Median(std::move(deviations)), kQuantisationSigmaDn);
  const auto limit = static_cast<float>(median + threshold * sigma);
  for (size_t i = 0; i < values_dn.size(); ++i) {
    defective[i] = static_cast<uint8_t>(defective[i] | (values_dn[i] > limit));
  }
  return median;
}

absl::Status CheckDarks(std::span<const Stack> darks) {
  if (darks.empty()) {
    return Rejected("darks", "none were recorded",
                    "record darks with every exposure and gain that the lights use");
  }
  for (const Stack& dark : darks) {
    if (dark.size() != darks[0].size() || dark.setting.gain_db != darks[0].setting.gain_db) {
      return BadInput(
          absl::StrCat("dark of ", Describe(dark.setting)),
          absl::StrCat("size or gain differ from the dark of ", Describe(darks[0].setting)),
          "look for hot pixels among darks of one gain and size");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DefectMap> FindHotPixels(std::span<const Stack> darks,
                                        const DefectOptions& options) {
  EYEBOX_RETURN_IF_ERROR(CheckDarks(darks));
  const auto [shortest, longest] = std::minmax_element(
      darks.begin(), darks.end(),
      [](const Stack& a, const Stack& b) { return a.setting.exposure_s < b.setting.exposure_s; });
  DefectMap map;
  map.defective = Image<uint8_t>(longest->size());
  const auto defective = map.defective.pixels();

  const auto counts = longest->mean_dn.pixels();
  std::vector<float> values(counts.begin(), counts.end());
  MarkOutliers(values, options.threshold, defective);

  const double span_s = longest->setting.exposure_s - shortest->setting.exposure_s;
  if (span_s > 0) {
    const auto at_shortest = shortest->mean_dn.pixels();
    for (size_t i = 0; i < values.size(); ++i) values[i] -= at_shortest[i];
    map.median_dark_rate_dn_s = MarkOutliers(values, options.threshold, defective) / span_s;
  }
  for (const Stack& dark : darks) {
    const auto saturated = dark.saturated_count.pixels();
    for (size_t i = 0; i < saturated.size(); ++i) {
      defective[i] = static_cast<uint8_t>(defective[i] | (saturated[i] > 0));
    }
  }
  map.hot_share = static_cast<double>(std::count(defective.begin(), defective.end(), 1)) /
                  static_cast<double>(defective.size());
  return map;
}

}  // namespace eyebox::optics
