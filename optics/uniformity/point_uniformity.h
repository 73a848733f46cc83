// Uniformity from a few points, in the style of the Information Display Measurements Standard
// (IDMS, "sampled uniformity"): 9 points at 10, 50 and 90 % of width and height; 13 with the four
// at 30 and 70 %.
#ifndef EYEBOX_OPTICS_UNIFORMITY_POINT_UNIFORMITY_H_
#define EYEBOX_OPTICS_UNIFORMITY_POINT_UNIFORMITY_H_

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/photometry/luminance_image.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// Mean over the valid pixels of a disk, unit of the image.
struct PatchMean {
  double x_px = 0;
  double y_px = 0;
  double radius_px = 0;
  double value = 0;
  double sigma = 0;          // with that of the scattered light
  double scatter_sigma = 0;  // of the scattered light alone, see LuminanceImage
  size_t pixels = 0;

  double NoiseVariance() const { return sigma * sigma - scatter_sigma * scatter_sigma; }
};

struct PointUniformity {
  std::vector<PatchMean> patches;  // rows from the top, left to right; then the four inner ones
  double uniformity = 0;           // min / max
  double nonuniformity = 0;        // 1 - min / max
  double sigma = 0;                // standard uncertainty of either, from noise and scattered light
};

// Standard uncertainty of numerator / denominator, of which scattered light's error is the same
// number in both.
double SigmaOfRatio(const PatchMean& numerator, const PatchMean& denominator);

// g at a patch.
struct PatchRatio {
  double x_px = 0;
  double y_px = 0;
  double value = 0;
  double sigma = 0;  // standard uncertainty
};

// Patch over reference, both means over disks of this image, which may have pixels in common. The
// reference is above 0.
PatchRatio RatioOf(const MeasuredImage& image, const PatchMean& patch, const PatchMean& reference);

// Errors: FailedPrecondition (no valid pixel in the disk).
absl::StatusOr<PatchMean> MeanOverDisk(const MeasuredImage& image, double x_px, double y_px,
                                       double radius_px);
absl::StatusOr<PatchMean> MeanOverDisk(const LuminanceImage& luminance, double x_px, double y_px,
                                       double radius_px);

enum class PointPattern { kNine, kThirteen };

// Errors: those of MeanOverDisk; FailedPrecondition (largest patch not above 0).
absl::StatusOr<PointUniformity> MeasurePointUniformity(const LuminanceImage& luminance,
                                                       PointPattern pattern, double radius_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_UNIFORMITY_POINT_UNIFORMITY_H_
