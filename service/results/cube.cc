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

void Describe(const fit::Certificate& certificate, v1::Certificate& message) {
  message.set_max_relative(certificate.max_relative);
  message.set_rms_relative(certificate.rms_relative);
  message.set_at_u(certificate.at_u);
  message.set_u_from(certificate.u_from);
  message.set_u_to(certificate.u_to);
  message.set_samples(certificate.samples);
}

}  // namespace

void AddStored(const fit::StoredCertificate& stored, v1::CubeResult& result) {
  v1::StorageCertificate& message = *result.add_storage_certificates();
  message.set_storage(fit::NameOf(stored.storage));
  Describe(stored.certificate, *message.mutable_certificate());
  message.set_worst_channel(std::string(fit::NameOf(stored.worst_channel)));
  message.set_contrast_step_8bit(stored.certificate.contrast_step_8bit);
}

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
  result.set_method(std::string(fit::NameOf(design.method)));
  if (!design.designed_for.IsExact()) result.set_designed_for(fit::NameOf(design.designed_for));
  result.set_contrast_step_8bit(design.certificate.contrast_step_8bit);
  Describe(design.certificate, *result.mutable_certificate());
  result.set_file(std::string(file));
  result.set_sha256(Sha256(bytes));
  result.mutable_knots_u()->Add(design.knots_u.begin(), design.knots_u.end());
  result.mutable_entries()->Add(design.entries.begin(), design.entries.end());
  AddWarnings(design, result);
  return result;
}

}  // namespace eyebox::service
