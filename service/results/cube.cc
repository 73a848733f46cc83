#include "service/results/cube.h"

#include <string>

#include "absl/strings/str_format.h"
#include "service/artifacts.h"
#include "service/results/activation.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

// A person sees luminance steps of about this size.
constexpr double kNotedError = 0.01;

void AddWarnings(const fit::TableDesign& design, v1::CubeResult& result) {
  const fit::Certificate& certificate = design.certificate;
  if (certificate.max_relative > kNotedError) {
    result.add_warnings(absl::StrFormat(
        "%s table of %d: the luminance is off by up to %.2f %% at u = %.4f; choose more entries "
        "or a target with floating-point entries",
        fit::NameOf(design.target), design.size, 100 * certificate.max_relative, certificate.at_u));
  }
  if (design.u_cutoff > certificate.u_from) {
    result.add_warnings(absl::StrFormat(
        "the display's minimum luminance hides everything below u = %.4f", design.u_cutoff));
  }
}

}  // namespace

v1::CubeResult DescribeCube(const fit::TableDesign& design, const v1::ActivationResult& activation,
                            std::string_view file, std::string_view bytes) {
  v1::CubeResult result;
  auto& parameters = *result.mutable_parameters();
  AddParameter(parameters, "size", design.size, 0, "1");
  const v1::Parameter white = MaximumLuminance(activation);
  AddParameter(parameters, "luminance_at_white", white.value(), white.sigma(), white.unit());
  AddParameter(parameters, "white_u", design.white_u, 0, "1");
  AddParameter(parameters, "u_cutoff", design.u_cutoff, 0, "1");
  result.set_target(std::string(fit::NameOf(design.target)));
  result.set_size(design.size);
  v1::Certificate& certificate = *result.mutable_certificate();
  certificate.set_max_relative(design.certificate.max_relative);
  certificate.set_rms_relative(design.certificate.rms_relative);
  certificate.set_at_u(design.certificate.at_u);
  certificate.set_u_from(design.certificate.u_from);
  certificate.set_u_to(design.certificate.u_to);
  certificate.set_samples(design.certificate.samples);
  result.set_file(std::string(file));
  result.set_sha256(Sha256(bytes));
  result.mutable_knots_u()->Add(design.knots_u.begin(), design.knots_u.end());
  result.mutable_entries()->Add(design.entries.begin(), design.entries.end());
  AddWarnings(design, result);
  return result;
}

}  // namespace eyebox::service
