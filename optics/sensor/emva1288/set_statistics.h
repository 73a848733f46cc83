// What EMVA 1288 takes from the images of one condition: a mean, a temporal and a spatial variance.
#ifndef EYEBOX_OPTICS_SENSOR_EMVA1288_SET_STATISTICS_H_
#define EYEBOX_OPTICS_SENSOR_EMVA1288_SET_STATISTICS_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/sensor_range.h"

namespace eyebox::optics {

// Images of one exposure time and one irradiation.
struct SetCondition {
  std::string where;  // for messages: "series.txt:12", "captures/000003.h5"
  bool dark = false;
  double exposure_s = 0;
  // Irradiation of a bright set: mean photons per pixel and exposure, or any quantity proportional
  // to it where photons are not known. 0 for darks.
  double irradiation = 0;
  std::optional<double> temperature_degC = {};
  double gain_db = 0;
  // Bright sets of one group saw light of one constant radiance: their irradiations are to scale.
  // Those of other groups are known up to a factor each.
  int group = 0;
};

// Part of the images; an empty size means all of them.
struct PixelRegion {
  int left_px = 0;
  int top_px = 0;
  ImageSize size = {};
};

// Variances are DN^2 of one pixel of one image, averaged over the pixels. `_sigma` is a standard
// uncertainty from the number of pixels and images alone.
struct SetStatistics {
  SetCondition condition;
  int images = 0;
  double pixels = 0;
  double mean_dn = 0;
  double mean_sigma_dn = 0;  // temporal noise only
  // Unbiased over the images; what their means differ by (drift) is taken out.
  double temporal_variance_dn2 = 0;
  double temporal_variance_sigma_dn2 = 0;
  // Of the mean image, less the temporal noise left in it; may come out below 0.
  double spatial_variance_dn2 = 0;
  double spatial_variance_sigma_dn2 = 0;
  // The same after subtracting the mean of each pixel's 5 x 5 neighbourhood, divided by 24/25 (the
  // share of a white pattern's variance that this leaves): uneven light is gone.
  double highpass_variance_dn2 = 0;
  double highpass_variance_sigma_dn2 = 0;
  double saturated_share = 0;  // of pixels at or above saturation in any image
};

// Adds up the images of one condition. Memory: five bytes a pixel, whatever their number; Finish()
// needs another twelve. Not thread-safe.
class SetAccumulator {
 public:
  // Pixels `colour_period_px` apart have one colour: 1 for a grey sensor, 2 for a Bayer mosaic,
  // whose colours then count as separate sensors with averaged variances.
  // Statistics are those of `region`, the stack is whole.
  SetAccumulator(SetCondition condition, const SensorRange& range, int colour_period_px,
                 const PixelRegion& region = {});

  // Errors: those of FrameStacker::Add, with the condition's place in front; InvalidArgument (the
  // region leaves the image).
  absl::Status Add(const FrameView& image);

  struct Finished {
    SetStatistics statistics;
    Stack stack;
  };
  // Leaves the accumulator empty. Errors: FailedPrecondition (fewer than two images),
  // InvalidArgument (images smaller than 6 x 6 pixels of a colour).
  absl::StatusOr<Finished> Finish();

  int images() const { return stacker_.frames(); }
  SetCondition& condition() { return condition_; }

 private:
  SetCondition condition_;
  int colour_period_px_;
  PixelRegion region_;
  FrameStacker stacker_;
  double square_sum_dn2_ = 0;  // over all pixels and images
  double mean_sum_dn_ = 0;     // over the images, of their means
  double mean_square_sum_dn2_ = 0;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_EMVA1288_SET_STATISTICS_H_
