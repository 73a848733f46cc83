#include "optics/reduce/reduce_band.h"

#include <algorithm>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/count_pixels.h"
#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/order_bracket.h"

namespace eyebox::optics {
namespace {

// So that what the steps of one exposure write stays in a second-level cache.
constexpr int kStripPixels = 1 << 14;

// One exposure of a strip, and what it borrows.
struct StripExposure {
  Stack light;
  DarkFrame dark;
  Exposure exposure;
};

void Crop(const Exposure& whole, Rows rows, StripExposure& strip) {
  const Stack& light = *whole.light;
  strip.light = {light.setting, light.range, light.frames, CropRows(light.mean_dn, rows),
                 CropRows(light.saturated_count, rows)};
  if (!light.rejected_count.empty()) {
    strip.light.rejected_count = CropRows(light.rejected_count, rows);
  }
  const MeasuredImage& dark = whole.dark->image_dn;
  strip.dark.setting = whole.dark->setting;
  strip.dark.image_dn = {CropRows(dark.value, rows), CropRows(dark.variance, rows),
                         CropRows(dark.mask, rows), dark.unit, dark.history};
  const Rows masked = {rows.first - whole.saturation_first_row,
                       rows.end - whole.saturation_first_row};
  strip.exposure = {&strip.light, &strip.dark, CropRows(whole.saturation, masked)};
}

void Count(const Exposure& exposure, const MeasuredImage& rate, PixelCounts& counts) {
  counts.saturated += CountPixels(exposure.light->saturated_count.pixels(),
                                  [](uint8_t frames) { return frames != 0; });
  const auto mask = std::as_const(rate.mask).pixels();
  counts.underexposed += CountPixels(mask, [](uint8_t m) { return (m & kUnderexposed) != 0; });
  counts.valid += CountPixels(mask, [](uint8_t m) { return m == 0; });
}

class StripReducer {
 public:
  StripReducer(std::span<const Exposure> bracket, const Calibration& calibration,
               const ReduceOptions& options, VarianceBudgetMeter& budget, BandSums& sums)
      : bracket_(bracket),
        options_(options),
        budget_(budget),
        sums_(sums),
        defects_(calibration.defects) {
    camera_.noise = calibration.noise;
    camera_.linearity = calibration.linearity;
    sums_.exposures.resize(bracket.size());
    sums_.pairs.resize(bracket.size() - 1);
  }

  absl::StatusOr<MeasuredImage> Reduce(Rows rows, const Image<float>& expected) {
    camera_.defects.defective = CropRows(defects_.defective, rows);
    const size_t first_pixel = static_cast<size_t>(rows.first) * expected.size().width_px;
    BracketMerger merger;
    MeasuredImage shorter;
    for (size_t k = 0; k < bracket_.size(); ++k) {
      StripExposure strip;
      Crop(bracket_[k], rows, strip);
      EYEBOX_ASSIGN_OR_RETURN(MeasuredImage rate,
                              RateOf(strip.exposure, expected, camera_, options_));
      Count(strip.exposure, rate, sums_.exposures[k]);
      if (k > 0) AddPair(shorter, rate, expected, sums_.pairs[k - 1]);
      EYEBOX_RETURN_IF_ERROR(merger.Add(rate));
      budget_.Add(strip.exposure, rate, expected, first_pixel);
      shorter = std::move(rate);
    }
    return merger.Finish();
  }

 private:
  std::span<const Exposure> bracket_;
  const ReduceOptions& options_;
  VarianceBudgetMeter& budget_;
  BandSums& sums_;
  const DefectMap& defects_;
  Calibration camera_;  // what the steps look at, of one strip
};

}  // namespace

absl::StatusOr<BandSums> ReduceBand(std::span<const Exposure> bracket,
                                    const Calibration& calibration, const ReduceOptions& options,
                                    Rows rows, MeasuredImage& merged, VarianceBudgetMeter& budget) {
  const auto [width, height] = merged.size();
  std::vector<Exposure> masked;
  for (const Exposure& exposure : bracket) masked.push_back({exposure.light, exposure.dark, {}});
  MaskSaturation(rows.Widened(options.smoothing_radius * options.colour_period_px, height), options,
                 masked);
  const Image<float> expected =
      ExpectedRate(masked, calibration, {options.smoothing_radius, options.colour_period_px}, rows);
  BandSums sums;
  StripReducer reducer(masked, calibration, options, budget, sums);
  const int strip_rows = std::max(kStripPixels / width, 1);
  for (int y = rows.first; y < rows.end; y += strip_rows) {
    const Rows strip = {y, std::min(y + strip_rows, rows.end)};
    const Rows in_band = {strip.first - rows.first, strip.end - rows.first};
    EYEBOX_ASSIGN_OR_RETURN(MeasuredImage reduced,
                            reducer.Reduce(strip, CropRows(expected, in_band)));
    PasteRows(reduced.value, y, merged.value);
    PasteRows(reduced.variance, y, merged.variance);
    PasteRows(reduced.mask, y, merged.mask);
    sums.history = std::move(reduced.history);
  }
  return sums;
}

}  // namespace eyebox::optics
