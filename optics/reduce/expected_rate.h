// What each pixel is expected to read, for the noise model.
//
// A variance computed from a pixel's own noisy count is small where the count came out low, and an
// inverse-variance mean then prefers low counts: it is biased by about minus one electron. The
// expectation is pooled over the exposures and smoothed, so that it hardly knows that noise.
#ifndef EYEBOX_OPTICS_REDUCE_EXPECTED_RATE_H_
#define EYEBOX_OPTICS_REDUCE_EXPECTED_RATE_H_

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "capture/base/image.h"
#include "optics/reduce/box_mean.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/rows.h"

namespace eyebox::optics {

// One exposure of the bracket, borrowed, and the dark that belongs to it, see DarkFor().
struct Exposure {
  const Stack* light = nullptr;
  std::shared_ptr<const DarkFrame> dark;
  Image<uint8_t> saturation;     // of light, see SaturationMask
  int saturation_first_row = 0;  // row of light that its first row belongs to
};

struct ExpectedRateOptions {
  int smoothing_radius = 2;  // window of (2 r + 1)^2 same-colour neighbours
  int colour_period_px = 2;
  // Where a pixel departs further from the mean of its window than this many of its own standard
  // deviations, the window straddles an edge and the pixel's own rate is taken.
  double edge_sigmas = 4;
};

// DN/s, [height, width]; NaN where no exposure is free of saturation and defects.
// The pooled rate is sum(counts) / sum(time) over those exposures: its weights are fixed
// beforehand, hence unbiased.
Image<float> ExpectedRate(std::span<const Exposure> exposures, const Calibration& calibration,
                          const ExpectedRateOptions& options);

// Those rows of it, one after the other, bit by bit as above. Rows of `saturation` within
// smoothing_radius * colour_period_px of them must be there. The arguments must outlive it.
class ExpectedRateRows {
 public:
  ExpectedRateRows(std::span<const Exposure> exposures, const Calibration& calibration,
                   const ExpectedRateOptions& options, Rows rows);

  // Of the first of `rows`, then of the next; valid until the next call.
  std::span<const float> Next();

 private:
  // Counts and time pooled over the usable exposures of one row.
  struct RowPool {
    std::vector<float> counts_dn;
    std::vector<float> time_s;
    std::vector<float> noise_dn2;  // of counts_dn, without the light's shot noise
  };
  // The variance of a rate R is dark_variance + shot_variance * R, (DN/s)^2.
  struct PooledRow {
    std::vector<float> rate_dn_s;
    std::vector<float> dark_variance;
    std::vector<float> shot_variance;  // per DN/s
  };

  void Pool(int y);

  std::span<const Exposure> exposures_;
  const Calibration& calibration_;
  float edge_squared_;
  Rows seen_;  // with the neighbours that the smoothing takes in
  int next_;   // row to be given
  int next_pooled_;
  RowPool pool_;
  std::vector<PooledRow> ring_;
  BoxMeanRows smooth_;
  std::vector<float> expected_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_EXPECTED_RATE_H_
