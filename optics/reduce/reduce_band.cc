#include "optics/reduce/reduce_band.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/count_pixels.h"
#include "optics/reduce/divide_by_exposure.h"
#include "optics/reduce/linearise.h"
#include "optics/reduce/measure_stack.h"
#include "optics/reduce/merge_bracket.h"
#include "optics/reduce/order_bracket.h"

namespace eyebox::optics {
namespace {

void Count(std::span<const uint8_t> saturated_count, std::span<const uint8_t> mask,
           PixelCounts& counts) {
  counts.saturated += CountPixels(saturated_count, [](uint8_t frames) { return frames != 0; });
  counts.underexposed += CountPixels(mask, [](uint8_t m) { return (m & kUnderexposed) != 0; });
  counts.valid += CountPixels(mask, [](uint8_t m) { return m == 0; });
}

// A row goes through all steps while it is in the first-level cache.
class RowReducer {
 public:
  RowReducer(std::span<const Exposure> bracket, const Calibration& calibration,
             const ReduceOptions& options, VarianceBudgetMeter& budget, BandSums& sums)
      : bracket_(bracket),
        calibration_(calibration),
        options_(options),
        budget_(budget),
        sums_(sums),
        rates_{UnwrittenMeasuredImage({Width(), 1}, "DN/s"),
               UnwrittenMeasuredImage({Width(), 1}, "DN/s")} {
    sums_.exposures.resize(bracket.size());
    sums_.pairs.resize(bracket.size() - 1);
  }

  void Reduce(int y, std::span<const float> expected_dn_s, const MeasuredRow& merged) {
    std::ranges::fill(merged.value, 0.0F);
    std::ranges::fill(merged.variance, 0.0F);
    std::ranges::fill(merged.mask, uint8_t{0});
    const size_t first_pixel = static_cast<size_t>(y) * Width();
    for (size_t k = 0; k < bracket_.size(); ++k) {
      const Exposure& exposure = bracket_[k];
      const MeasuredRow rate = PixelsOf(rates_[k % 2]);
      MeasureRowAboveDark(exposure, y, expected_dn_s, calibration_.noise, calibration_.defects,
                          options_.rail_guard_sigmas, rate);
      if (calibration_.linearity) LinearisePixels(*calibration_.linearity, rate);
      DividePixelsByExposure(exposure.light->setting.exposure_s, rate);
      Count(exposure.light->saturated_count.row(y), rate.mask, sums_.exposures[k]);
      if (k > 0) AddPair(PixelsOf(rates_[1 - k % 2]), rate, expected_dn_s, sums_.pairs[k - 1]);
      AddToMerge(rate, merged);
      budget_.Add(exposure, rate, expected_dn_s, first_pixel);
    }
    FinishMerge(merged);
  }

 private:
  int Width() const { return bracket_[0].light->size().width_px; }

  std::span<const Exposure> bracket_;
  const Calibration& calibration_;
  const ReduceOptions& options_;
  VarianceBudgetMeter& budget_;
  BandSums& sums_;
  MeasuredImage rates_[2];  // of this exposure and of the one before
};

// The exposure without a pixel.
struct Empty {
  explicit Empty(const Exposure& whole) {
    const Rows none = {0, 0};
    light = {whole.light->setting, whole.light->range, whole.light->frames,
             CropRows(whole.light->mean_dn, none), CropRows(whole.light->saturated_count, none)};
    dark.setting = whole.dark->setting;
    dark.image_dn = UnwrittenMeasuredImage(light.size(), whole.dark->image_dn.unit);
    dark.image_dn.history = whole.dark->image_dn.history;
  }
  Stack light;
  DarkFrame dark;
};

}  // namespace

absl::StatusOr<std::vector<std::string>> HistoryOf(std::span<const Exposure> bracket,
                                                   const Calibration& calibration,
                                                   const ReduceOptions& options) {
  Calibration camera;
  camera.noise = calibration.noise;
  camera.linearity = calibration.linearity;
  BracketMerger merger;
  for (const Exposure& exposure : bracket) {
    const Empty empty(exposure);
    camera.defects.defective = Image<uint8_t>(empty.light.size());
    const Exposure of_nothing{&empty.light,
                              {std::shared_ptr<const DarkFrame>(), &empty.dark},
                              Image<uint8_t>(empty.light.size())};
    EYEBOX_ASSIGN_OR_RETURN(const MeasuredImage rate,
                            RateOf(of_nothing, Image<float>(empty.light.size()), camera, options));
    EYEBOX_RETURN_IF_ERROR(merger.Add(rate));
  }
  EYEBOX_ASSIGN_OR_RETURN(MeasuredImage merged, merger.Finish());
  return std::move(merged.history);
}

BandSums ReduceBand(std::span<const Exposure> bracket, const Calibration& calibration,
                    const ReduceOptions& options, Rows rows, MeasuredImage& merged,
                    VarianceBudgetMeter& budget) {
  std::vector<Exposure> masked;
  for (const Exposure& exposure : bracket) masked.push_back({exposure.light, exposure.dark, {}});
  const int reach = options.smoothing_radius * options.colour_period_px;
  MaskSaturation(rows.Widened(reach, merged.size().height_px), options, masked);
  ExpectedRateRows expected(masked, calibration,
                            {options.smoothing_radius, options.colour_period_px}, rows);
  BandSums sums;
  RowReducer reducer(masked, calibration, options, budget, sums);
  for (int y = rows.first; y < rows.end; ++y) {
    reducer.Reduce(y, expected.Next(), RowOf(merged, y));
  }
  return sums;
}

}  // namespace eyebox::optics
