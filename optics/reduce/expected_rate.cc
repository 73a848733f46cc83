#include "optics/reduce/expected_rate.h"

#include <algorithm>
#include <utility>

#include "capture/base/vectorise.h"
#include "optics/reduce/box_mean.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {
namespace {

struct PooledRate {
  Image<float> rate_dn_s;
  // The variance of a rate R is dark_variance + shot_variance * R, (DN/s)^2.
  Image<float> dark_variance;
  Image<float> shot_variance;  // per DN/s
};

// Counts and time pooled over the usable exposures of one row.
struct RowPool {
  explicit RowPool(int width) : counts_dn(width), time_s(width), noise_dn2(width) {}
  std::vector<float> counts_dn;
  std::vector<float> time_s;
  std::vector<float> noise_dn2;  // of counts_dn, without the light's shot noise
};

EYEBOX_VECTORISE
void AddExposure(const Exposure& exposure, std::span<const uint8_t> defective, int y,
                 const NoiseModel& noise, RowPool& pool) {
  const auto light = exposure.light->mean_dn.row(y);
  const auto saturation = exposure.saturation.row(y - exposure.saturation_first_row);
  const auto dark = exposure.dark->image_dn.value.row(y);
  const auto dark_variance = exposure.dark->image_dn.variance.row(y);
  const auto dark_mask = exposure.dark->image_dn.mask.row(y);
  const auto frames = static_cast<float>(exposure.light->frames);
  const float time_s = frames * static_cast<float>(exposure.light->setting.exposure_s);
  const auto light_noise = frames * static_cast<float>(noise.MeanVariance(0, 1));
  float* const counts_dn = pool.counts_dn.data();
  float* const times_s = pool.time_s.data();
  float* const noise_dn2 = pool.noise_dn2.data();
  for (size_t x = 0; x < light.size(); ++x) {
    const bool usable = (saturation[x] | dark_mask[x] | defective[x]) == 0;
    const float counts = frames * (light[x] - dark[x]);
    const float variance = light_noise + frames * frames * dark_variance[x];
    counts_dn[x] += usable ? counts : 0.0F;
    times_s[x] += usable ? time_s : 0.0F;
    noise_dn2[x] += usable ? variance : 0.0F;
  }
}

EYEBOX_VECTORISE
void Divide(const RowPool& pool, float gain, int row, PooledRate& pooled) {
  float* const rate = pooled.rate_dn_s.row(row).data();
  float* const dark_variance = pooled.dark_variance.row(row).data();
  float* const shot_variance = pooled.shot_variance.row(row).data();
  const float* const time_s = pool.time_s.data();
  const float* const counts_dn = pool.counts_dn.data();
  const float* const noise_dn2 = pool.noise_dn2.data();
  const size_t width = pool.time_s.size();
  for (size_t x = 0; x < width; ++x) {
    const float per_s = 1.0F / time_s[x];
    rate[x] = time_s[x] > 0 ? counts_dn[x] * per_s : kNoValue;
    dark_variance[x] = noise_dn2[x] * per_s * per_s;
    shot_variance[x] = gain * per_s;
  }
}

// The mean of the neighbours, but for an edge: there the pixel itself. Into pooled.rate_dn_s.
EYEBOX_VECTORISE
void SmoothButForEdges(const Image<float>& smooth, float edge, PooledRate& pooled) {
  float* const rate = pooled.rate_dn_s.pixels().data();
  const float* const dark_variance = pooled.dark_variance.pixels().data();
  const float* const shot_variance = pooled.shot_variance.pixels().data();
  const float* const mean = smooth.pixels().data();
  const size_t count = smooth.pixels().size();
  for (size_t i = 0; i < count; ++i) {
    const float departure = rate[i] - mean[i];
    // At the higher of the two: a count that came out low must not make its own noise look small,
    // or it passes for an edge.
    const float higher = std::max(std::max(rate[i], mean[i]), 0.0F);
    const float variance = dark_variance[i] + shot_variance[i] * higher;
    // False for NaN, which then stays NaN.
    rate[i] = departure * departure <= edge * variance ? mean[i] : rate[i];
  }
}

PooledRate PoolExposures(std::span<const Exposure> exposures, const Calibration& calibration,
                         Rows rows) {
  const ImageSize size{exposures[0].light->size().width_px, rows.count()};
  const auto gain = static_cast<float>(calibration.noise.gain_dn_per_e);
  PooledRate pooled{Image<float>::Unwritten(size), Image<float>::Unwritten(size),
                    Image<float>::Unwritten(size)};
  for (int y = rows.first; y < rows.end; ++y) {
    RowPool pool(size.width_px);
    for (const Exposure& exposure : exposures) {
      AddExposure(exposure, calibration.defects.defective.row(y), y, calibration.noise, pool);
    }
    Divide(pool, gain, y - rows.first, pooled);
  }
  return pooled;
}

}  // namespace

Image<float> ExpectedRate(std::span<const Exposure> exposures, const Calibration& calibration,
                          const ExpectedRateOptions& options) {
  return ExpectedRate(exposures, calibration, options, AllRows(exposures[0].light->size()));
}

Image<float> ExpectedRate(std::span<const Exposure> exposures, const Calibration& calibration,
                          const ExpectedRateOptions& options, Rows rows) {
  const int reach = options.smoothing_radius * options.colour_period_px;
  const Rows seen = rows.Widened(reach, exposures[0].light->size().height_px);
  PooledRate pooled = PoolExposures(exposures, calibration, seen);
  const Image<float> smooth =
      BoxMean(pooled.rate_dn_s, options.smoothing_radius, options.colour_period_px);
  const auto edge = static_cast<float>(options.edge_sigmas * options.edge_sigmas);
  SmoothButForEdges(smooth, edge, pooled);
  if (seen.count() == rows.count()) return std::move(pooled.rate_dn_s);
  return CropRows(pooled.rate_dn_s, {rows.first - seen.first, rows.end - seen.first});
}

}  // namespace eyebox::optics
