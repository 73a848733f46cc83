#include "optics/reduce/measure_exposure_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/order_bracket.h"

namespace eyebox::optics {
namespace {

constexpr double kBinsPerOctave = 8;
constexpr double kFewestPixels = 100;
constexpr float kOutshineFactor = 2;

struct BinSums {
  double pixels = 0;
  double shorter = 0;
  double longer = 0;
  double shorter_variance = 0;
  double longer_variance = 0;
};

void AddPairs(const MeasuredImage& shorter, const MeasuredImage& longer, double ratio,
              const Image<float>& expected_rate_dn_s, const Image<uint8_t>& outshone,
              std::vector<LinearityPair>& pairs) {
  std::map<int, BinSums> bins;
  const auto expected = expected_rate_dn_s.pixels();
  for (size_t i = 0; i < expected.size(); ++i) {
    if ((shorter.mask.pixels()[i] | longer.mask.pixels()[i] | outshone.pixels()[i]) != 0) continue;
    if (!(expected[i] > 0)) continue;
    BinSums& bin = bins[static_cast<int>(std::floor(kBinsPerOctave * std::log2(expected[i])))];
    ++bin.pixels;
    bin.shorter += shorter.value.pixels()[i];
    bin.longer += longer.value.pixels()[i];
    bin.shorter_variance += shorter.variance.pixels()[i];
    bin.longer_variance += longer.variance.pixels()[i];
  }
  for (const auto& [index, bin] : bins) {
    if (bin.pixels < kFewestPixels) continue;
    const double squared = bin.pixels * bin.pixels;
    pairs.push_back({bin.shorter / bin.pixels, bin.longer / bin.pixels, ratio,
                     bin.shorter_variance / squared, bin.longer_variance / squared});
  }
}

}  // namespace

Image<uint8_t> OutshonePixels(const Image<float>& expected_rate_dn_s) {
  const auto [width, height] = expected_rate_dn_s.size();
  Image<uint8_t> outshone(expected_rate_dn_s.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float limit = kOutshineFactor * std::max(expected_rate_dn_s.at(x, y), 0.0F);
      for (int row = std::max(y - 1, 0); row <= std::min(y + 1, height - 1); ++row) {
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, width - 1); ++column) {
          if (expected_rate_dn_s.at(column, row) > limit) outshone.at(x, y) = 1;
        }
      }
    }
  }
  return outshone;
}

absl::StatusOr<std::vector<LinearityPair>> MeasureExposurePairs(std::span<const Stack> exposures,
                                                                const Calibration& calibration,
                                                                const ReduceOptions& options) {
  ReduceOptions strict = options;
  strict.saturation_dilation = std::max(options.saturation_dilation, 1);
  strict.saturation_step_px = 1;
  Calibration raw = calibration;
  raw.linearity.reset();
  EYEBOX_ASSIGN_OR_RETURN(std::vector<Exposure> bracket, OrderBracket(exposures, raw));
  MaskSaturation(AllRows(bracket[0].light->size()), strict, bracket);
  const Image<float> expected =
      ExpectedRate(bracket, raw, {options.smoothing_radius, options.colour_period_px});
  const Image<uint8_t> outshone = OutshonePixels(expected);
  std::vector<LinearityPair> pairs;
  MeasuredImage shorter;
  double shorter_s = 0;
  for (const Exposure& exposure : bracket) {
    const double exposure_s = exposure.light->setting.exposure_s;
    EYEBOX_ASSIGN_OR_RETURN(MeasuredImage counts, CountsOf(exposure, expected, raw, strict));
    if (shorter_s > 0) AddPairs(shorter, counts, exposure_s / shorter_s, expected, outshone, pairs);
    shorter = std::move(counts);
    shorter_s = exposure_s;
  }
  return pairs;
}

}  // namespace eyebox::optics
