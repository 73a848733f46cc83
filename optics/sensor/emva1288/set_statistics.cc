#include "optics/sensor/emva1288/set_statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/reduce/box_mean.h"

namespace eyebox::optics {
namespace {

constexpr int kBoxRadius = 2;
constexpr double kWhiteShare = 24.0 / 25;  // of variance that the high-pass lets through
constexpr int kSmallestSide = 6;           // of one colour, so that the 5 x 5 box has a place

// Unbiased variance within each colour, averaged over the colours; a border of `margin` is left
// out. Shifted by the first value against cancellation.
struct SpatialVariance {
  double variance = 0;
  double pixels = 0;
};

SpatialVariance VarianceWithinColours(const Image<float>& image, int period, int margin) {
  const auto [width, height] = image.size();
  SpatialVariance result;
  for (int phase = 0; phase < period * period; ++phase) {
    double count = 0;
    double sum = 0;
    double squares = 0;
    const double shift = image.at(margin + phase % period, margin + phase / period);
    for (int y = margin + phase / period; y < height - margin; y += period) {
      const auto row = image.row(y);
      for (int x = margin + phase % period; x < width - margin; x += period) {
        const double value = row[x] - shift;
        ++count;
        sum += value;
        squares += value * value;
      }
    }
    result.variance += (squares - sum * sum / count) / (count - 1) / (period * period);
    result.pixels += count;
  }
  return result;
}

template <typename T>
Image<T> Cropped(const Image<T>& image, const PixelRegion& region) {
  Image<T> part(region.size);
  for (int y = 0; y < region.size.height_px; ++y) {
    const auto row = image.row(region.top_px + y).subspan(region.left_px, region.size.width_px);
    std::copy(row.begin(), row.end(), part.row(y).begin());
  }
  return part;
}

double RelativeVarianceSigma(double freedom) { return std::sqrt(2 / freedom); }

void AddSpatial(const Image<float>& mean_dn, int period, SetStatistics& set) {
  const double left_over = set.temporal_variance_dn2 / set.images;
  const SpatialVariance raw = VarianceWithinColours(mean_dn, period, 0);
  set.spatial_variance_dn2 = raw.variance - left_over;
  set.spatial_variance_sigma_dn2 = raw.variance * RelativeVarianceSigma(raw.pixels);
  Image<float> detail = BoxMean(mean_dn, kBoxRadius, period);
  for (size_t i = 0; i < detail.pixels().size(); ++i) {
    detail.pixels()[i] = mean_dn.pixels()[i] - detail.pixels()[i];
  }
  const SpatialVariance high = VarianceWithinColours(detail, period, kBoxRadius * period);
  set.highpass_variance_dn2 = high.variance / kWhiteShare - left_over;
  set.highpass_variance_sigma_dn2 =
      high.variance / kWhiteShare * RelativeVarianceSigma(high.pixels);
}

}  // namespace

SetAccumulator::SetAccumulator(SetCondition condition, const SensorRange& range,
                               int colour_period_px, const PixelRegion& region)
    : condition_(std::move(condition)),
      colour_period_px_(colour_period_px),
      region_(region),
      stacker_({condition_.exposure_s, condition_.gain_db}, range) {}

absl::Status SetAccumulator::Add(const FrameView& image) {
  if (absl::Status status = stacker_.Add(image); !status.ok()) {
    return {status.code(), absl::StrCat(condition_.where, ": ", status.message())};
  }
  if (region_.size.PixelCount() == 0) region_ = {0, 0, image.size};
  const auto [width, height] = region_.size;
  if (region_.left_px < 0 || region_.top_px < 0 || region_.left_px + width > image.size.width_px ||
      region_.top_px + height > image.size.height_px) {
    return BadInput(condition_.where, "the region to measure leaves the image",
                    "choose one inside the frames");
  }
  uint64_t sum = 0;
  uint64_t squares = 0;  // 16-bit counts of 2^32 pixels fit
  for (int y = region_.top_px; y < region_.top_px + height; ++y) {
    const size_t row = static_cast<size_t>(y) * image.size.width_px + region_.left_px;
    for (const uint16_t dn : image.pixels_dn.subspan(row, width)) {
      sum += dn;
      squares += static_cast<uint64_t>(dn) * dn;
    }
  }
  const double mean_dn = static_cast<double>(sum) / static_cast<double>(region_.size.PixelCount());
  square_sum_dn2_ += static_cast<double>(squares);
  mean_sum_dn_ += mean_dn;
  mean_square_sum_dn2_ += mean_dn * mean_dn;
  return absl::OkStatus();
}

absl::StatusOr<SetAccumulator::Finished> SetAccumulator::Finish() {
  const int images = stacker_.frames();
  if (images < 2) {
    return Rejected(condition_.where, absl::StrCat("it has ", images, " image(s)"),
                    "record at least two images of every condition");
  }
  EYEBOX_ASSIGN_OR_RETURN(Stack stack, stacker_.Finish());
  if (std::min(region_.size.width_px, region_.size.height_px) < kSmallestSide * colour_period_px_) {
    return BadInput(condition_.where, "the images are too small for the 5 x 5 high-pass",
                    "use images of at least 6 x 6 pixels of each colour");
  }
  SetStatistics set{condition_, images, static_cast<double>(region_.size.PixelCount())};
  const Image<float> mean_dn = Cropped(stack.mean_dn, region_);
  set.mean_dn = mean_sum_dn_ / images;
  double mean_squares = 0;
  for (const float mean : mean_dn.pixels()) mean_squares += static_cast<double>(mean) * mean;
  const double within = square_sum_dn2_ - images * mean_squares;
  const double drift = mean_square_sum_dn2_ - images * set.mean_dn * set.mean_dn;
  const double freedom = set.pixels * (images - 1);
  set.temporal_variance_dn2 = std::max(within / freedom - drift / (images - 1), 0.0);
  set.temporal_variance_sigma_dn2 = set.temporal_variance_dn2 * RelativeVarianceSigma(freedom);
  set.mean_sigma_dn = std::sqrt(set.temporal_variance_dn2 / (set.pixels * images));
  const Image<uint8_t> region_saturated = Cropped(stack.saturated_count, region_);
  const auto saturated = region_saturated.pixels();
  set.saturated_share =
      static_cast<double>(saturated.size() -
                          static_cast<size_t>(std::count(saturated.begin(), saturated.end(), 0))) /
      set.pixels;
  AddSpatial(mean_dn, colour_period_px_, set);
  square_sum_dn2_ = mean_sum_dn_ = mean_square_sum_dn2_ = 0;
  return Finished{set, std::move(stack)};
}

}  // namespace eyebox::optics
