#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "optics/reduce/reduce_level.h"
#include "optics/uniformity/point_uniformity.h"

namespace eyebox::optics {
namespace {

constexpr double kReferenceRadius = 0.05;  // of the smaller side of the image

absl::StatusOr<PatchMean> CentralMean(const MeasuredImage& rate) {
  const auto [width, height] = rate.size();
  return MeanOverDisk(rate, 0.5 * (width - 1), 0.5 * (height - 1),
                      std::max(kReferenceRadius * std::min(width, height), 1.0));
}

}  // namespace

absl::StatusOr<FlatField> MeasureFlat(std::span<const Stack> exposures,
                                      const Calibration& calibration,
                                      const std::optional<KnownLuminance>& luminance,
                                      const ReduceOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(ReducedRate reduced, ReduceRate(exposures, calibration, options));
  EYEBOX_ASSIGN_OR_RETURN(const PatchMean centre, CentralMean(reduced.rate));
  if (!(centre.value > 5 * centre.sigma)) {
    return Rejected(
        "flat",
        absl::StrCat("no light at its centre: ", centre.value, " +- ", centre.sigma, " DN/s"),
        "record a uniform source at about half of full scale");
  }
  FlatField flat{std::move(reduced.rate), luminance};
  if (luminance.has_value()) return flat;
  const auto per_centre = static_cast<float>(1 / centre.value);
  for (float& value : flat.response.value.pixels()) value *= per_centre;
  for (float& variance : flat.response.variance.pixels()) variance *= per_centre * per_centre;
  flat.response.unit = std::string("1");  // not assigned from a literal: GCC 12 warns falsely
  flat.response.history.push_back(
      absl::StrCat("MeasureFlat(normalised to 1 at the centre, ", centre.value, " DN/s)"));
  return flat;
}

}  // namespace eyebox::optics
