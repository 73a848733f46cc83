#include "fit/scatter/fit_with_field.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/uniformity/point_uniformity.h"

namespace eyebox::fit {
namespace {

// From the axis to the farthest corner.
double CornerPx(ImageSize size, const optics::PixelPoint& axis) {
  const double across = std::max(axis.x_px, size.width_px - 1 - axis.x_px);
  const double down = std::max(axis.y_px, size.height_px - 1 - axis.y_px);
  return std::hypot(across, down);
}

// Mean over each ring of equal width around the axis, to the farthest corner. What lies beside the
// image is dark or as its border. A ring without a valid pixel is as the one before.
std::vector<double> RingMeans(const optics::MeasuredImage& field, const BrightField& where,
                              int rings, double corner_px) {
  const auto [width, height] = field.size();
  const auto reach = static_cast<int>(std::ceil(corner_px));
  const auto axis_x = static_cast<int>(std::lround(where.axis.x_px));
  const auto axis_y = static_cast<int>(std::lround(where.axis.y_px));
  std::vector<double> sum(rings), pixels(rings);
  for (int y = axis_y - reach; y <= axis_y + reach; ++y) {
    const int row = std::clamp(y, 0, height - 1);
    for (int x = axis_x - reach; x <= axis_x + reach; ++x) {
      const double r = std::hypot(x - where.axis.x_px, y - where.axis.y_px);
      const auto ring = static_cast<int>(r / corner_px * rings);
      if (ring >= rings) continue;
      const int column = std::clamp(x, 0, width - 1);
      const bool inside = row == y && column == x;
      const bool dark = !inside && where.surround == optics::Surround::kDark;
      if (!dark && field.mask.at(column, row) != 0) continue;
      sum[ring] += dark ? 0 : field.value.at(column, row);
      ++pixels[ring];
    }
  }
  for (int k = 0; k < rings; ++k) {
    const double before = k > 0 ? sum[k - 1] : 0;
    sum[k] = pixels[k] > 0 ? sum[k] / pixels[k] : before;
  }
  return sum;
}

// Largest move of a kernel parameter, in its sigmas; held ones do not move.
double MoveInSigmas(const ScatterFit& before, const ScatterFit& after) {
  double most = 0;
  for (int i = 0; i < kKernelParameters; ++i) {
    const Parameter& parameter = after.parameters[i];
    if (!(parameter.sigma > 0)) continue;
    const double move = std::abs(parameter.value - before.parameters[i].value);
    most = std::max(most, move / parameter.sigma);
  }
  return most;
}

}  // namespace

absl::Status FieldFitOptions::Validate() const {
  EYEBOX_RETURN_IF_ERROR(fit.Validate());
  if (rings < 2 || rings > 64) {
    return BadInput("rings", absl::StrCat(rings), "give 2 to 64 rings");
  }
  if (most_rounds < 1) {
    return BadInput("most_rounds", absl::StrCat(most_rounds), "give 1 or more");
  }
  if (settled > 0) return absl::OkStatus();
  return BadInput("settled", absl::StrCat(settled), "give a number of sigmas above 0");
}

absl::StatusOr<std::vector<FieldRing>> MeasureFieldRings(const optics::MeasuredImage& field,
                                                         const BrightField& where, int rings,
                                                         double field_radius_deg) {
  if (rings < 2) return BadInput("rings", absl::StrCat(rings), "give 2 or more");
  EYEBOX_ASSIGN_OR_RETURN(
      const optics::PatchMean middle,
      optics::MeanOverDisk(field, where.axis.x_px, where.axis.y_px, where.reference_radius_px));
  if (!(middle.value > 0)) {
    return Rejected("bright field", absl::StrCat("luminance ", middle.value, " on the axis"),
                    "record a bright full field");
  }
  const double corner_px = CornerPx(field.size(), where.axis);
  std::vector<FieldRing> result;
  for (const double mean : RingMeans(field, where, rings, corner_px)) {
    const double outer_px = corner_px * static_cast<double>(result.size() + 1) / rings;
    result.push_back({outer_px * where.pitch_deg, std::max(mean / middle.value, 0.0)});
  }
  if (where.surround != optics::Surround::kDark &&
      result.back().outer_radius_deg < field_radius_deg) {
    result.push_back({field_radius_deg, result.back().relative});
  }
  return result;
}

absl::StatusOr<FieldFit> FitScatterWithField(const GlareSeries& series, const BrightField& field,
                                             const FieldFitOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  GlareSeries with_field = series;
  FieldFit result;
  const optics::MeasuredImage* seen = &field.luminance.image;
  std::optional<ScatterFit> before;
  while (result.rounds < options.most_rounds && !result.settled) {
    EYEBOX_ASSIGN_OR_RETURN(
        with_field.field, MeasureFieldRings(*seen, field, options.rings, series.field_radius_deg));
    EYEBOX_ASSIGN_OR_RETURN(result.fit, before ? FitScatterFrom(*before, with_field, options.fit)
                                               : FitScatter(with_field, options.fit));
    EYEBOX_ASSIGN_OR_RETURN(
        result.removal,
        optics::RemoveGlare(field.luminance, {result.fit.kernel, result.fit.glare_relative_sigma,
                                              field.pitch_deg, field.surround}));
    seen = &result.removal.luminance.image;
    ++result.rounds;
    result.settled = before && MoveInSigmas(*before, result.fit) < options.settled;
    before = result.fit;
  }
  result.field = std::move(with_field.field);
  return result;
}

}  // namespace eyebox::fit
