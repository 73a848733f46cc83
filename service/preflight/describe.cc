#include "service/preflight/describe.h"

#include <algorithm>
#include <string>

#include "capture/base/version.h"

namespace eyebox::service {
namespace {

v1::CheckVerdict ToProto(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return v1::CHECK_VERDICT_PASSED;
    case Verdict::kFailed:
      return v1::CHECK_VERDICT_FAILED;
    case Verdict::kSkipped:
      return v1::CHECK_VERDICT_SKIPPED;
  }
  return v1::CHECK_VERDICT_UNSPECIFIED;
}

v1::Parameter ToProto(const Figure& figure) {
  v1::Parameter proto;
  proto.set_name(figure.name);
  proto.set_value(figure.value);
  proto.set_sigma(figure.sigma);
  proto.set_unit(figure.unit);
  return proto;
}

v1::PreflightCheck ToProto(const Check& check) {
  v1::PreflightCheck proto;
  proto.set_name(check.name);
  proto.set_verdict(ToProto(check.verdict));
  if (check.measured) *proto.mutable_measured() = ToProto(*check.measured);
  proto.set_wanted(check.wanted);
  proto.set_threshold(check.threshold);
  proto.set_cause(check.cause);
  proto.set_remedy(check.remedy);
  for (const Figure& figure : check.figures) *proto.add_parameters() = ToProto(figure);
  return proto;
}

}  // namespace

v1::PreflightResult DescribePreflight(std::span<const Check> checks, const capture::Rig& rig,
                                      std::span<const double> exposures_s, int64_t real_ns) {
  v1::PreflightResult result;
  const auto count = [&](const std::string& name, Verdict verdict) {
    const auto number = std::ranges::count(checks, verdict, &Check::verdict);
    *result.add_parameters() = ToProto({name, static_cast<double>(number), 0, "1"});
    return number;
  };
  count("checks_passed", Verdict::kPassed);
  result.set_passed(count("checks_failed", Verdict::kFailed) == 0 && !checks.empty());
  count("checks_skipped", Verdict::kSkipped);
  result.set_rig(rig.config.name);
  result.set_camera_uri(rig.config.camera_uri);
  result.set_camera_serial(rig.camera->Info().serial);
  result.set_photodiode_uri(rig.config.photodiode_uri);
  for (const Check& check : checks) *result.add_checks() = ToProto(check);
  result.set_measured_real_ns(real_ns);
  result.set_software_version(std::string(kVersion));
  result.mutable_exposures_s()->Add(exposures_s.begin(), exposures_s.end());
  return result;
}

}  // namespace eyebox::service
