#include "optics/reduce/expected_rate.h"

#include <algorithm>

#include "capture/base/vectorise.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {
namespace {

struct Time {
  float frames;
  float all_s;        // of all frames
  float light_noise;  // DN^2, of the sum of their counts without light
};

// What is added is of all frames of one exposure, where nothing speaks against it.
EYEBOX_VECTORISE
void AddCounts(const Exposure& exposure, std::span<const uint8_t> defective, int y, Time time,
               float* __restrict__ counts_dn, float* __restrict__ times_s,
               float* __restrict__ noise_dn2) {
  const float* const light = exposure.light->mean_dn.row(y).data();
  const uint8_t* const saturation =
      exposure.saturation.row(y - exposure.saturation_first_row).data();
  const float* const dark = exposure.dark->image_dn.value.row(y).data();
  const float* const dark_variance = exposure.dark->image_dn.variance.row(y).data();
  const uint8_t* const dark_mask = exposure.dark->image_dn.mask.row(y).data();
  const uint8_t* const hot = defective.data();
  const size_t width = defective.size();
  for (size_t x = 0; x < width; ++x) {
    const bool usable = (saturation[x] | dark_mask[x] | hot[x]) == 0;
    const float counts = time.frames * (light[x] - dark[x]);
    const float variance = time.light_noise + time.frames * time.frames * dark_variance[x];
    counts_dn[x] += usable ? counts : 0.0F;
    times_s[x] += usable ? time.all_s : 0.0F;
    noise_dn2[x] += usable ? variance : 0.0F;
  }
}

EYEBOX_VECTORISE
void DividePool(const float* counts_dn, const float* time_s, const float* noise_dn2, float gain,
                size_t width, float* __restrict__ rate, float* __restrict__ dark_variance,
                float* __restrict__ shot_variance) {
  for (size_t x = 0; x < width; ++x) {
    const float per_s = 1.0F / time_s[x];
    rate[x] = time_s[x] > 0 ? counts_dn[x] * per_s : kNoValue;
    dark_variance[x] = noise_dn2[x] * per_s * per_s;
    shot_variance[x] = gain * per_s;
  }
}

// In `mean`: the mean of the neighbours, but for an edge: there the pixel's own rate.
EYEBOX_VECTORISE
void KeepEdges(const float* rate, const float* dark_variance, const float* shot_variance,
               float edge_squared, size_t width, float* __restrict__ mean) {
  for (size_t x = 0; x < width; ++x) {
    const float departure = rate[x] - mean[x];
    // At the higher of the two: a count that came out low must not make its own noise look small,
    // or it passes for an edge.
    const float higher = std::max(std::max(rate[x], mean[x]), 0.0F);
    const float variance = dark_variance[x] + shot_variance[x] * higher;
    // False for NaN, which then stays NaN.
    mean[x] = departure * departure <= edge_squared * variance ? mean[x] : rate[x];
  }
}

}  // namespace

ExpectedRateRows::ExpectedRateRows(std::span<const Exposure> exposures,
                                   const Calibration& calibration,
                                   const ExpectedRateOptions& options, Rows rows)
    : exposures_(exposures),
      calibration_(calibration),
      edge_squared_(static_cast<float>(options.edge_sigmas * options.edge_sigmas)),
      next_(rows.first),
      smooth_(exposures[0].light->size().width_px, options.smoothing_radius,
              options.colour_period_px) {
  seen_ = rows.Widened(smooth_.reach(), exposures[0].light->size().height_px);
  next_pooled_ = seen_.first;
  expected_.resize(exposures[0].light->size().width_px);
  pool_ = {expected_, expected_, expected_};
  ring_.assign(static_cast<size_t>(smooth_.reach()) + 1, {expected_, expected_, expected_});
}

void ExpectedRateRows::Pool(int y) {
  std::ranges::fill(pool_.counts_dn, 0.0F);
  std::ranges::fill(pool_.time_s, 0.0F);
  std::ranges::fill(pool_.noise_dn2, 0.0F);
  for (const Exposure& exposure : exposures_) {
    const auto frames = static_cast<float>(exposure.light->frames);
    const Time time{frames, frames * static_cast<float>(exposure.light->setting.exposure_s),
                    frames * static_cast<float>(calibration_.noise.MeanVariance(0, 1))};
    AddCounts(exposure, calibration_.defects.defective.row(y), y, time, pool_.counts_dn.data(),
              pool_.time_s.data(), pool_.noise_dn2.data());
  }
  PooledRow& pooled = ring_[static_cast<size_t>(y) % ring_.size()];
  DividePool(pool_.counts_dn.data(), pool_.time_s.data(), pool_.noise_dn2.data(),
             static_cast<float>(calibration_.noise.gain_dn_per_e), pooled.rate_dn_s.size(),
             pooled.rate_dn_s.data(), pooled.dark_variance.data(), pooled.shot_variance.data());
  smooth_.Push(y, pooled.rate_dn_s);
}

std::span<const float> ExpectedRateRows::Next() {
  const int y = next_++;
  for (; next_pooled_ < std::min(y + smooth_.reach() + 1, seen_.end); ++next_pooled_) {
    Pool(next_pooled_);
  }
  smooth_.Mean(y, seen_, expected_);
  const PooledRow& pooled = ring_[static_cast<size_t>(y) % ring_.size()];
  KeepEdges(pooled.rate_dn_s.data(), pooled.dark_variance.data(), pooled.shot_variance.data(),
            edge_squared_, expected_.size(), expected_.data());
  return expected_;
}

Image<float> ExpectedRate(std::span<const Exposure> exposures, const Calibration& calibration,
                          const ExpectedRateOptions& options) {
  const ImageSize size = exposures[0].light->size();
  ExpectedRateRows rows(exposures, calibration, options, AllRows(size));
  Image<float> expected = Image<float>::Unwritten(size);
  for (int y = 0; y < size.height_px; ++y) {
    std::ranges::copy(rows.Next(), expected.row(y).begin());
  }
  return expected;
}

}  // namespace eyebox::optics
