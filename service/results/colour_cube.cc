#include <string>

#include "absl/strings/str_format.h"
#include "service/artifacts.h"
#include "service/results/colour.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

// A person sees luminance steps of about this size.
constexpr double kNotedError = 0.01;
constexpr double kNotedShare = 0.999;

v1::Certificate ToProto(const fit::Certificate& certificate) {
  v1::Certificate message;
  message.set_max_relative(certificate.max_relative);
  message.set_rms_relative(certificate.rms_relative);
  message.set_at_u(certificate.at_u);
  message.set_u_from(certificate.u_from);
  message.set_u_to(certificate.u_to);
  message.set_samples(certificate.samples);
  return message;
}

void AddRamps(const fit::ColourTable& table, v1::ColourCubeResult& result) {
  *result.mutable_certificate() = ToProto(table.ramps[0].luminance);
  for (const fit::RampCertificate& ramp : table.ramps) {
    v1::ColourRampCertificate& message = *result.add_ramps();
    message.set_name(ramp.name);
    *message.mutable_luminance() = ToProto(ramp.luminance);
    message.set_max_chromaticity_error(ramp.max_chromaticity_error);
    message.set_at_u_chromaticity(ramp.at_u_chromaticity);
    message.set_u_reachable(ramp.u_reachable);
  }
  const fit::InteriorCertificate& interior = table.interior;
  result.set_interior_max_relative(interior.max_relative);
  result.set_interior_rms_relative(interior.rms_relative);
  result.set_interior_max_chromaticity_error(interior.max_chromaticity_error);
  result.set_interior_rms_chromaticity_error(interior.rms_chromaticity_error);
  result.set_interior_colours(interior.colours);
  result.set_interior_colours_outside(interior.colours_outside);
}

void AddEntryCounts(const fit::EntryCount& count, v1::ColourCubeResult& result) {
  result.set_entries_in_range(count.in_range);
  result.set_entries_outside_gamut(count.outside_gamut);
  result.set_entries_limited_by_black(count.limited_by_black);
  result.set_entries_too_bright(count.too_bright);
  result.set_outside_gamut_max_chromaticity_error(count.max_chromaticity_error);
}

void AddGamutWarnings(const fit::ColourTable& table, v1::ColourCubeResult& result) {
  if (table.goal.share_of_maximum < kNotedShare) {
    result.add_warnings(absl::StrFormat(
        "white is %.1f %% of the display's maximum luminance: no brighter one of this "
        "chromaticity leaves every colour reachable (see --scale)",
        100 * table.goal.share_of_maximum));
  }
  const fit::EntryCount& count = table.entries;
  if (count.outside_gamut > 0) {
    result.add_warnings(absl::StrFormat(
        "%d of %d entries lie outside the display's gamut: shown with their luminance, their "
        "chromaticity off by up to %.4f u'v'",
        count.outside_gamut, count.in_range, count.max_chromaticity_error));
  }
  if (count.too_bright > 0) {
    result.add_warnings(absl::StrFormat("%d of %d entries are brighter than the display: clipped",
                                        count.too_bright, count.in_range));
  }
}

void AddWarnings(const fit::ColourTable& table, const v1::ColourResult& colour,
                 v1::ColourCubeResult& result) {
  if (!colour.colour_certified()) result.add_warnings(colour.verdict());
  AddGamutWarnings(table, result);
  for (const fit::RampCertificate& ramp : table.ramps) {
    if (ramp.luminance.max_relative <= kNotedError) continue;
    result.add_warnings(
        absl::StrFormat("%s: the luminance is off by up to %.2f %% at u = %.4f of white", ramp.name,
                        100 * ramp.luminance.max_relative, ramp.luminance.at_u));
  }
}

}  // namespace

v1::ColourCubeResult DescribeColourCube(const fit::ColourTable& table, const fit::GoalOptions& goal,
                                        const v1::ColourResult& colour, std::string_view file,
                                        std::string_view bytes) {
  v1::ColourCubeResult result;
  auto& parameters = *result.mutable_parameters();
  const fit::Xyz white = table.goal.White();
  AddParameter(parameters, "size", table.size, 0, "1");
  AddParameter(parameters, "luminance_at_white", white[1], 0, "cd/m2");
  AddParameter(parameters, "share_of_maximum", table.goal.share_of_maximum, 0, "1");
  AddParameter(parameters, "white_u", table.white_u, 0, "1");
  result.set_target(std::string(fit::NameOf(table.target)));
  result.set_size(table.size);
  result.set_gamut(std::string(fit::NameOf(goal.gamut)));
  result.set_scale(std::string(fit::NameOf(goal.scale)));
  result.mutable_white()->set_x(white[0]);
  result.mutable_white()->set_y(white[1]);
  result.mutable_white()->set_z(white[2]);
  AddRamps(table, result);
  AddEntryCounts(table.entries, result);
  result.set_colour_certified(colour.colour_certified());
  result.set_file(std::string(file));
  result.set_sha256(Sha256(bytes));
  result.mutable_knots_u()->Add(table.knots_u.begin(), table.knots_u.end());
  AddWarnings(table, colour, result);
  return result;
}

}  // namespace eyebox::service
