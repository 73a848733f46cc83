#include "service/server/handlers/validate_run.h"

#include <string>

#include "capture/base/status.h"
#include "service/server/store/names.h"

namespace eyebox::service {
namespace {

struct SizeRule {
  std::string_view field;
  int32_t (v1::CreateRunRequest::*value)() const;
  int min;
  int max;
};

// As RunOptions in service/pipeline.h.
constexpr SizeRule kSizes[] = {
    {"hdrp_cube_size", &v1::CreateRunRequest::hdrp_cube_size, 2, 129},
    {"pps_strip_size", &v1::CreateRunRequest::pps_strip_size, 2, 32},
};

struct OptionalName {
  const NameRule& rule;
  std::string_view field;
  const std::string& name;
};

absl::Status ValidateSource(const v1::CreateRunRequest& request) {
  switch (request.source_case()) {
    case v1::CreateRunRequest::kRecording:
      return CheckName(kRecordingRule, "recording", request.recording()).status();
    case v1::CreateRunRequest::kRig:
      return ValidateRig(request.rig());
    case v1::CreateRunRequest::SOURCE_NOT_SET:
      break;
  }
  return BadField("source", "is missing", "give a recording or a rig");
}

}  // namespace

absl::Status ValidateRig(const v1::Rig& rig) {
  EYEBOX_RETURN_IF_ERROR(CheckName(kRigRule, "rig.name", rig.name()).status());
  if (!rig.sensor().empty()) {
    return BadField("rig.sensor", "is given, and no path of a client is followed",
                    "record with the command line, or put sensor/ into the recording");
  }
  EYEBOX_RETURN_IF_ERROR(CheckName(kCameraRule, "rig.camera_uri", rig.camera_uri()).status());
  const OptionalName optional[] = {
      {kPhotodiodeRule, "rig.photodiode_uri", rig.photodiode_uri()},
      {kTriggerRule, "rig.trigger_uri", rig.trigger_uri()},
      {kLineRule, "rig.camera_trigger_line", rig.camera_trigger_line()}};
  for (const OptionalName& one : optional) {
    if (one.name.empty()) continue;
    EYEBOX_RETURN_IF_ERROR(CheckName(one.rule, one.field, one.name).status());
  }
  return absl::OkStatus();
}

absl::Status ValidateClip(const std::string& field, double sigmas) {
  if (sigmas == 0 || (sigmas >= 3 && sigmas <= 100)) return absl::OkStatus();
  return BadField(field, "is " + std::to_string(sigmas), "give 0, or 3 to 100");
}

absl::Status ValidateRun(const v1::CreateRunRequest& request) {
  EYEBOX_RETURN_IF_ERROR(CheckName(kRequestIdRule, "request_id", request.request_id()).status());
  return ValidateRunWork(request);
}

absl::Status ValidateRunWork(const v1::CreateRunRequest& request) {
  EYEBOX_RETURN_IF_ERROR(ValidateSource(request));
  for (const SizeRule& rule : kSizes) {
    const int value = (request.*rule.value)();
    if (value == 0 || (value >= rule.min && value <= rule.max)) continue;
    return BadField(rule.field, "is " + std::to_string(value),
                    "give " + std::to_string(rule.min) + " to " + std::to_string(rule.max) +
                        ", or 0 for the default");
  }
  return ValidateClip("clip_sigmas", request.clip_sigmas());
}

}  // namespace eyebox::service
