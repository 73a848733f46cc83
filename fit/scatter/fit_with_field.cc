#include "fit/scatter/fit_with_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/scatter/radial_profile.h"
#include "optics/uniformity/point_uniformity.h"

namespace eyebox::fit {
namespace {

// From the axis to the farthest corner.
double CornerPx(ImageSize size, const optics::PixelPoint& axis) {
  const double across = std::max(axis.x_px, size.width_px - 1 - axis.x_px);
  const double down = std::max(axis.y_px, size.height_px - 1 - axis.y_px);
  return std::hypot(across, down);
}

// Share of a ring that lies within the image.
double ShareInside(ImageSize size, const optics::PixelPoint& axis, double inner_px,
                   double outer_px) {
  const double nearest = std::min({axis.x_px, axis.y_px, size.width_px - 1 - axis.x_px,
                                   size.height_px - 1 - axis.y_px}) +
                         0.5;
  if (outer_px <= nearest) return 1;
  double pixels = 0;
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      const double r = std::hypot(x - axis.x_px, y - axis.y_px);
      pixels += r >= inner_px && r < outer_px ? 1 : 0;
    }
  }
  const double area = std::numbers::pi * (outer_px * outer_px - inner_px * inner_px);
  return std::min(pixels / area, 1.0);
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
  const double last_deg = CornerPx(field.size(), where.axis) * where.pitch_deg;
  std::vector<FieldRing> result;
  for (int k = 0; k < rings; ++k) {
    const std::vector<double> edges = {last_deg * k / rings, last_deg * (k + 1) / rings};
    const auto ring = optics::MeasureRadialProfile(field, where.axis.x_px, where.axis.y_px,
                                                   where.pitch_deg, edges);
    // A ring without a valid pixel is taken to go on as the one before.
    if (!ring.ok() && !absl::IsFailedPrecondition(ring.status())) return ring.status();
    const double before = result.empty() ? 1 : result.back().relative;
    const double relative = ring.ok() ? std::max(ring->front().value / middle.value, 0.0) : before;
    result.push_back({edges.back(), relative});
  }
  if (where.surround == optics::Surround::kDark) {
    double inner_px = 0;
    for (FieldRing& ring : result) {
      const double outer_px = ring.outer_radius_deg / where.pitch_deg;
      ring.relative *= ShareInside(field.size(), where.axis, inner_px, outer_px);
      inner_px = outer_px;
    }
  } else {
    result.back().outer_radius_deg = std::max(result.back().outer_radius_deg, field_radius_deg);
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
    EYEBOX_ASSIGN_OR_RETURN(result.fit, FitScatter(with_field, options.fit));
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
