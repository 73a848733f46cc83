#include "optics/uniformity/uniformity_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

struct Disk {
  PixelPoint centre;
  double radius_px = 0;
  bool Holds(int x, int y) const {
    return std::hypot(x - centre.x_px, y - centre.y_px) <= radius_px;
  }
};

absl::StatusOr<Disk> ReferenceDisk(ImageSize size, const UniformityOptions& options) {
  const PixelPoint centre{0.5 * (size.width_px - 1), 0.5 * (size.height_px - 1)};
  const PixelPoint reference = options.reference.value_or(centre);
  const bool inside = reference.x_px >= 0 && reference.x_px <= size.width_px - 1 &&
                      reference.y_px >= 0 && reference.y_px <= size.height_px - 1;
  if (!inside) {
    return BadInput(
        "uniformity",
        absl::StrCat("the reference point (", reference.x_px, ", ", reference.y_px,
                     ") is outside the image of ", size.width_px, " x ", size.height_px, " pixels"),
        "choose a point inside");
  }
  const double radius = options.reference_radius_fraction * std::min(size.width_px, size.height_px);
  return Disk{reference, std::max(radius, 1.0)};
}

// g = L / R, var g = (var L + g^2 var R - 2 g cov(L, R)) / R^2. Inside the disk R contains the
// pixel itself with weight 1/n, hence cov(L, R) = var L / n. What all pixels share of scattered
// light, s, shifts g by (s - g s_R) / R.
void RatioToReference(const LuminanceImage& luminance, const Disk& disk, const PatchMean& reference,
                      UniformityMap& map) {
  MeasuredImage& ratio = map.raw;
  ratio = luminance.image;
  map.scatter_sigma = luminance.scatter_sigma;
  const double per_reference = 1 / reference.value;
  const double reference_variance = reference.NoiseVariance();
  for (int y = 0; y < ratio.size().height_px; ++y) {
    const bool near = std::abs(y - disk.centre.y_px) <= disk.radius_px;
    const auto value = ratio.value.row(y);
    const auto variance = ratio.variance.row(y);
    for (int x = 0; x < ratio.size().width_px; ++x) {
      const double g = value[x] * per_reference;
      const double shared =
          near && disk.Holds(x, y) ? 2 * g / static_cast<double>(reference.pixels) : 0;
      double sum = variance[x] * (1 - shared) + g * g * reference_variance;
      if (!map.scatter_sigma.empty()) {
        float& scatter = map.scatter_sigma.at(x, y);
        const double shift = scatter - g * reference.scatter_sigma;
        scatter = static_cast<float>(shift * per_reference);
        sum += shift * shift;
      }
      value[x] = static_cast<float>(g);
      variance[x] = static_cast<float>(sum * per_reference * per_reference);
    }
  }
  ratio.unit = "1";
  ratio.history.push_back(absl::StrCat("RatioToReference(point (", disk.centre.x_px, ", ",
                                       disk.centre.y_px, "), radius ", disk.radius_px, " px)"));
}

// The size that predicts best balances what it cannot follow against noise. So the next larger one
// is taken, whose bias is small, and the one after that tells how much is still left out.
constexpr size_t kIntervalStepsAboveBest = 1;

size_t PlaceOf(const std::vector<CrossValidated>& tried, int size) {
  const auto at = std::ranges::find(tried, size, &CrossValidated::size);
  return static_cast<size_t>(at - tried.begin());
}

absl::StatusOr<SmoothField> FitSpline(const LuminanceImage& full_field, const FieldChoice& choice,
                                      std::optional<int> asked) {
  int intervals = asked.value_or(0);
  std::optional<int> larger;
  if (!asked) {
    const size_t last = choice.splines.size() - 1;
    const size_t at =
        std::min(PlaceOf(choice.splines, choice.spline.size) + kIntervalStepsAboveBest, last);
    intervals = choice.splines[at].size;
    if (at < last) larger = choice.splines[at + 1].size;
  }
  return FitSmoothField(full_field.image, FieldModel::kSpline, intervals, full_field.scatter_sigma,
                        larger);
}

absl::StatusOr<SmoothField> FitPolynomial(const LuminanceImage& full_field,
                                          const FieldChoice& choice, std::optional<int> asked) {
  const Image<float>& scatter = full_field.scatter_sigma;
  if (!asked) return FitWeightedPolynomial(full_field.image, choice.weighted.size, scatter);
  return FitSmoothField(full_field.image, FieldModel::kPolynomial, *asked, scatter);
}

// Both kinds of smooth model; the kind that predicts better first. With a size given, that kind is
// taken.
absl::Status FitSmoothModels(const LuminanceImage& full_field, const UniformityOptions& options,
                             const PixelPoint& reference, UniformityMap& map) {
  EYEBOX_ASSIGN_OR_RETURN(map.choice, CrossValidate(full_field.image));
  EYEBOX_ASSIGN_OR_RETURN(const SmoothField polynomial,
                          FitPolynomial(full_field, map.choice, options.polynomial_order));
  map.polynomial_order = polynomial.order;
  map.polynomial_weighted =
      polynomial.effective_functions < static_cast<double>(polynomial.coefficients.size());
  EYEBOX_ASSIGN_OR_RETURN(map.smooth, NormaliseAt(polynomial, reference.x_px, reference.y_px));
  if (map.choice.splines.empty() && !options.spline_intervals) return absl::OkStatus();
  EYEBOX_ASSIGN_OR_RETURN(const SmoothField spline,
                          FitSpline(full_field, map.choice, options.spline_intervals));
  map.spline_intervals = spline.order;
  EYEBOX_ASSIGN_OR_RETURN(map.alternative, NormaliseAt(spline, reference.x_px, reference.y_px));
  const bool asked_one =
      options.polynomial_order.has_value() != options.spline_intervals.has_value();
  const bool take_spline =
      asked_one ? options.spline_intervals.has_value() : map.choice.spline_is_better;
  if (take_spline) std::swap(map.smooth, *map.alternative);
  return absl::OkStatus();
}

AreaUniformity MeasureArea(const SmoothField& smooth, const Image<float>& values,
                           const Image<uint8_t>& mask) {
  size_t lowest = values.pixels().size();
  size_t highest = lowest;
  double sum = 0, squares = 0, pixels = 0;
  for (size_t i = 0; i < values.pixels().size(); ++i) {
    if (mask.pixels()[i] != 0) continue;
    const double g = values.pixels()[i];
    if (pixels == 0 || g < values.pixels()[lowest]) lowest = i;
    if (pixels == 0 || g > values.pixels()[highest]) highest = i;
    sum += g;
    squares += g * g;
    ++pixels;
  }
  const auto sigma_at = [&](size_t i) {
    const size_t width = values.size().width_px;
    const size_t x = i % width;
    const size_t y = i / width;
    return smooth.SigmaAt(static_cast<double>(x), static_cast<double>(y));
  };
  AreaUniformity area;
  area.g = {values.pixels()[lowest], values.pixels()[highest]};
  area.minimum_sigma = sigma_at(lowest);
  area.maximum_sigma = sigma_at(highest);
  area.mean = sum / pixels;
  area.deviation = std::sqrt(std::max(squares / pixels - area.mean * area.mean, 0.0));
  area.uniformity = area.g.minimum / area.g.maximum;
  area.uniformity_sigma =
      std::hypot(area.minimum_sigma, area.uniformity * area.maximum_sigma) / area.g.maximum;
  return area;
}

void CompareRawAndSmooth(UniformityMap& map) {
  const Image<float> smooth = map.smooth.Values();
  map.area = MeasureArea(map.smooth, smooth, map.raw.mask);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  map.raw_range = map.smooth_range = {kInfinity, -kInfinity};
  const auto extend = [](FieldRange& range, double g) {
    range.minimum = std::min(range.minimum, g);
    range.maximum = std::max(range.maximum, g);
  };
  double squares = 0;
  double expected = 0;
  size_t pixels = 0;
  for (size_t i = 0; i < smooth.pixels().size(); ++i) {
    if (map.raw.mask.pixels()[i] != 0) continue;
    const double raw = map.raw.value.pixels()[i];
    const double model = smooth.pixels()[i];
    extend(map.raw_range, raw);
    extend(map.smooth_range, model);
    squares += (raw - model) * (raw - model);
    const double shared = map.scatter_sigma.empty() ? 0 : map.scatter_sigma.pixels()[i];
    expected += map.raw.variance.pixels()[i] - shared * shared;
    ++pixels;
  }
  map.residual_rms = std::sqrt(squares / static_cast<double>(pixels));
  map.residual_rms_expected = std::sqrt(expected / static_cast<double>(pixels));
}

std::vector<PatchRatio> RatiosOf(const MeasuredImage& luminance, const PointUniformity& points,
                                 const PatchMean& reference) {
  std::vector<PatchRatio> ratios;
  for (const PatchMean& patch : points.patches) {
    ratios.push_back(RatioOf(luminance, patch, reference));
  }
  return ratios;
}

}  // namespace

absl::StatusOr<UniformityMap> MeasureUniformity(const LuminanceImage& full_field,
                                                const UniformityOptions& options) {
  const MeasuredImage& luminance = full_field.image;
  EYEBOX_ASSIGN_OR_RETURN(const Disk disk, ReferenceDisk(luminance.size(), options));
  EYEBOX_ASSIGN_OR_RETURN(
      const PatchMean reference,
      MeanOverDisk(full_field, disk.centre.x_px, disk.centre.y_px, disk.radius_px));
  if (!(reference.value > 5 * reference.sigma)) {
    return Rejected("uniformity",
                    absl::StrCat("luminance ", reference.value, " +- ", reference.sigma,
                                 " at the reference point"),
                    "measure uniformity on a level that is lit, or expose longer");
  }
  UniformityMap map;
  map.reference = disk.centre;
  map.reference_luminance = reference.value;
  map.reference_luminance_sigma = reference.sigma;
  RatioToReference(full_field, disk, reference, map);
  EYEBOX_RETURN_IF_ERROR(FitSmoothModels(full_field, options, disk.centre, map));
  CompareRawAndSmooth(map);
  const double patch_px =
      std::max(options.patch_radius_fraction *
                   std::min(luminance.size().width_px, luminance.size().height_px),
               1.0);
  EYEBOX_ASSIGN_OR_RETURN(map.nine_points,
                          MeasurePointUniformity(full_field, PointPattern::kNine, patch_px));
  EYEBOX_ASSIGN_OR_RETURN(map.thirteen_points,
                          MeasurePointUniformity(full_field, PointPattern::kThirteen, patch_px));
  map.g_of_nine_points = RatiosOf(luminance, map.nine_points, reference);
  map.g_of_thirteen_points = RatiosOf(luminance, map.thirteen_points, reference);
  return map;
}

}  // namespace eyebox::optics
