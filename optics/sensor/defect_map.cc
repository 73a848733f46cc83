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

constexpr int kNeighbourhoodRadius = 2;

// Median of the 5 x 5 same-colour neighbours, without those beyond the edges. A mean would let one
// dead pixel mark its neighbours.
class NeighbourMedian {
 public:
  NeighbourMedian(const Image<float>& image, int period) : image_(image), period_(period) {}

  float At(int x, int y) {
    neighbours_.clear();
    const auto [width, height] = image_.size();
    for (int dy = -kNeighbourhoodRadius; dy <= kNeighbourhoodRadius; ++dy) {
      const int row = y + dy * period_;
      if (row < 0 || row >= height) continue;
      for (int dx = -kNeighbourhoodRadius; dx <= kNeighbourhoodRadius; ++dx) {
        const int column = x + dx * period_;
        if (column >= 0 && column < width) neighbours_.push_back(image_.at(column, row));
      }
    }
    const auto middle = neighbours_.begin() + static_cast<std::ptrdiff_t>(neighbours_.size() / 2);
    std::nth_element(neighbours_.begin(), middle, neighbours_.end());
    return *middle;
  }

 private:
  const Image<float>& image_;
  int period_;
  std::vector<float> neighbours_;
};

// Relative to their neighbours' median, minus 1; 0 where there is no signal to compare with.
std::vector<float> Departures(const Image<float>& signal_dn, int period) {
  NeighbourMedian median(signal_dn, period);
  std::vector<float> departures;
  departures.reserve(signal_dn.pixels().size());
  for (int y = 0; y < signal_dn.size().height_px; ++y) {
    for (int x = 0; x < signal_dn.size().width_px; ++x) {
      const float around = median.At(x, y);
      departures.push_back(around >= 1 ? signal_dn.at(x, y) / around - 1 : 0);
    }
  }
  return departures;
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

absl::Status AddDeadPixels(const Stack& bright, const Stack& dark, const DefectOptions& options,
                           DefectMap& map) {
  if (bright.size() != dark.size() || bright.size() != map.defective.size()) {
    return BadInput("bright stack", "its size differs from the dark's or the defect map's",
                    "use stacks of one region of interest");
  }
  Image<float> signal_dn = bright.mean_dn;
  double sum = 0;
  for (size_t i = 0; i < signal_dn.pixels().size(); ++i) {
    signal_dn.pixels()[i] -= dark.mean_dn.pixels()[i];
    sum += signal_dn.pixels()[i];
  }
  const std::vector<float> departures = Departures(signal_dn, options.colour_period_px);
  std::vector<float> sizes(departures.size());
  std::transform(departures.begin(), departures.end(), sizes.begin(),
                 [](float departure) { return std::abs(departure); });
  const double mean_dn = std::max(sum / static_cast<double>(sizes.size()), 1.0);
  const double sigma = std::max(kMadToSigma * Median(sizes), kQuantisationSigmaDn / mean_dn);
  size_t dead = 0;
  for (size_t i = 0; i < sizes.size(); ++i) {
    if (!(sizes[i] > options.threshold * sigma)) continue;
    ++dead;
    map.defective.pixels()[i] = 1;
  }
  map.dead_share = static_cast<double>(dead) / static_cast<double>(sizes.size());
  return absl::OkStatus();
}

}  // namespace eyebox::optics
