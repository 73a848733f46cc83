#include "service/results/field_verdict.h"

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "service/artifacts.h"
#include "service/steps/field_regions.h"

namespace eyebox::service {
namespace {

bool HasCutoff(const v1::ActivationResult& result) {
  for (const v1::Parameter& parameter : result.parameters()) {
    if (parameter.name() == "cutoff_drive") return parameter.value() > 0;
  }
  return false;
}

v1::FieldVerdict Describe(const FieldRegions& regions) {
  const fit::RegionComparison& comparison = regions.comparison;
  v1::FieldVerdict verdict;
  verdict.set_region_rows(regions.rows);
  verdict.set_region_columns(regions.columns);
  for (const fit::RegionExponent& region : comparison.regions) {
    v1::RegionExponent& added = *verdict.add_regions();
    added.set_row(region.region / regions.columns);
    added.set_column(region.region % regions.columns);
    added.set_locations(static_cast<int64_t>(region.fit.locations));
    added.set_gamma(region.fit.gamma);
    added.set_gamma_sigma(region.fit.gamma_sigma);
    added.set_rms_relative(
        std::sqrt(region.fit.weighted_sum_of_squares / static_cast<double>(region.fit.readings)));
  }
  verdict.set_f_statistic(comparison.f);
  verdict.set_numerator_degrees_of_freedom(comparison.numerator_freedom);
  verdict.set_denominator_degrees_of_freedom(comparison.denominator_freedom);
  verdict.set_p_value(comparison.p_value);
  verdict.set_delta_bic(comparison.delta_bic);
  verdict.set_one_exponent_serves(comparison.one_serves);
  verdict.set_reason(comparison.reason);
  return verdict;
}

}  // namespace

absl::Status AddFieldVerdict(const MeasuredLevels& levels, const std::filesystem::path& folder,
                             v1::ActivationResult& result) {
  const absl::StatusOr<FieldRegions> regions = CompareFieldRegions(levels, HasCutoff(result));
  if (!regions.ok()) {
    result.add_warnings(absl::StrCat("whether one exponent serves the field was not tested: ",
                                     std::string(regions.status().message())));
    return absl::OkStatus();
  }
  v1::CommonExponentResult& field = *result.mutable_field();
  *field.mutable_verdict() = Describe(*regions);
  Image<float> gamma({regions->columns, regions->rows}, std::numeric_limits<float>::quiet_NaN());
  Image<float> sigma = gamma;
  for (const v1::RegionExponent& region : field.verdict().regions()) {
    gamma.at(region.column(), region.row()) = static_cast<float>(region.gamma());
    sigma.at(region.column(), region.row()) = static_cast<float>(region.gamma_sigma());
  }
  EYEBOX_ASSIGN_OR_RETURN(*field.add_maps(),
                          WriteMap(folder, "field_gamma.npy", "gamma", "1", gamma));
  EYEBOX_ASSIGN_OR_RETURN(*field.add_maps(),
                          WriteMap(folder, "field_gamma_sigma.npy", "gamma_sigma", "1", sigma));
  if (!field.verdict().one_exponent_serves()) {
    result.add_warnings(absl::StrCat(field.verdict().reason(),
                                     ": one table leaves errors away from the reference point"));
  }
  return absl::OkStatus();
}

}  // namespace eyebox::service
