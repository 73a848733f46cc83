#include "optics/scatter/remove_glare.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "optics/scatter/correct_scatter.h"
#include "optics/scatter/spread_light.h"

namespace eyebox::optics {
namespace {

// Wide enough for all glare, unless that is more than another image on each side.
int MarginPx(ImageSize size, const KnownGlare& glare) {
  if (glare.surround == Surround::kDark) return 0;
  const double reach_px = std::ceil(glare.kernel.reach_deg / glare.pitch_deg);
  return static_cast<int>(
      std::min(reach_px, static_cast<double>(std::max(size.width_px, size.height_px))));
}

// The image in the middle of a larger one that goes on as at its border.
LuminanceImage Surrounded(const LuminanceImage& reading, int margin, Surround surround) {
  const auto [width, height] = reading.image.size();
  LuminanceImage wide = reading;
  wide.image = MakeMeasuredImage({width + 2 * margin, height + 2 * margin}, reading.image.unit);
  wide.image.history = reading.image.history;
  for (int y = 0; y < height + 2 * margin; ++y) {
    const int source_y = std::clamp(y - margin, 0, height - 1);
    for (int x = 0; x < width + 2 * margin; ++x) {
      const int source_x = std::clamp(x - margin, 0, width - 1);
      const bool inside = source_x == x - margin && source_y == y - margin;
      const bool guessed = !inside && surround == Surround::kUnknown;
      wide.image.value.at(x, y) = reading.image.value.at(source_x, source_y);
      wide.image.variance.at(x, y) = reading.image.variance.at(source_x, source_y);
      wide.image.mask.at(x, y) =
          guessed ? uint8_t{kNoData} : reading.image.mask.at(source_x, source_y);
    }
  }
  BlankMaskedPixels(wide.image);
  return wide;
}

template <typename T>
Image<T> Cropped(const Image<T>& wide, int margin, ImageSize size) {
  Image<T> image(size);
  for (int y = 0; y < size.height_px; ++y) {
    const auto row = wide.row(y + margin).subspan(margin, size.width_px);
    std::ranges::copy(row, image.row(y).begin());
  }
  return image;
}

double Median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Fills the variances and the figures; the value stands already.
void Account(const MeasuredImage& before, const CorrectionOptions& options, GlareRemoval& removal) {
  MeasuredImage& after = removal.luminance.image;
  Image<float>& common = removal.luminance.scatter_sigma;
  common = Image<float>(after.size(), kNoValue);
  const double sigma_of_floor = options.floor_tolerance / options.floor_sigmas;
  double read = 0, left = 0, variance_before = 0, variance_after = 0, common_squares = 0;
  std::vector<float> floors;
  size_t below = 0;
  for (size_t i = 0; i < after.value.pixels().size(); ++i) {
    if (after.mask.pixels()[i] != 0) continue;
    const float floor = removal.floor.pixels()[i];
    const double whole = sigma_of_floor * floor;
    const double shared =
        options.glare_relative_sigma * (before.value.pixels()[i] - after.value.pixels()[i]);
    // Single precision may lose the difference where the kernel is nearly all of the variance.
    const double own =
        std::max(whole * whole - shared * shared, static_cast<double>(before.variance.pixels()[i]));
    after.variance.pixels()[i] = static_cast<float>(own);
    common.pixels()[i] = static_cast<float>(shared);
    read += before.value.pixels()[i];
    left += after.value.pixels()[i];
    variance_before += before.variance.pixels()[i];
    variance_after += own;
    common_squares += shared * shared;
    floors.push_back(floor);
    below += after.value.pixels()[i] < floor ? 1 : 0;
  }
  if (floors.empty()) return;
  GlareRemovalFigures& figures = removal.figures;
  figures.removed_share = read != 0 ? 1 - left / read : 0;
  figures.below_floor_share = static_cast<double>(below) / static_cast<double>(floors.size());
  figures.variance_share = std::max(1 - variance_before / variance_after, 0.0);
  figures.common_share = variance_after > 0 ? common_squares / variance_after : 0;
  figures.floor_median = Median(std::move(floors));
}

}  // namespace

absl::StatusOr<GlareRemoval> RemoveGlare(const LuminanceImage& reading, const KnownGlare& glare) {
  const ImageSize size = reading.image.size();
  EYEBOX_RETURN_IF_ERROR(CheckGrid(size, glare.pitch_deg));
  EYEBOX_RETURN_IF_ERROR(glare.kernel.Validate());
  const int margin = MarginPx(size, glare);
  const CorrectionOptions options{.glare_relative_sigma = glare.relative_sigma};
  const LuminanceImage wide = Surrounded(reading, margin, glare.surround);
  EYEBOX_ASSIGN_OR_RETURN(
      ScatterCorrector corrector,
      ScatterCorrector::Create(glare.kernel, wide.image.size(), glare.pitch_deg, options));
  EYEBOX_ASSIGN_OR_RETURN(const ScatterCorrection corrected, corrector.Correct(wide));
  GlareRemoval removal;
  removal.luminance = reading;
  removal.luminance.image.value = Cropped(corrected.luminance.image.value, margin, size);
  removal.luminance.image.history = corrected.luminance.image.history;
  removal.floor = Cropped(corrected.floor, margin, size);
  Account(reading.image, options, removal);
  return removal;
}

}  // namespace eyebox::optics
