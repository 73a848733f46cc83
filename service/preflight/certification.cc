#include "service/preflight/certification.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/result_json.h"

namespace eyebox::service {
namespace {

std::string NamesWith(const v1::PreflightResult& preflight, v1::CheckVerdict verdict) {
  std::vector<std::string> names;
  for (const v1::PreflightCheck& check : preflight.checks()) {
    if (check.verdict() == verdict) names.push_back(check.name());
  }
  return absl::StrJoin(names, ", ");
}

// A replay has the serial number of the camera that it replays, and a URI of its own.
bool SameCamera(const v1::PreflightResult& preflight, const capture::RecordingHeader& header) {
  if (preflight.camera_serial().empty() && header.camera.serial.empty()) {
    return preflight.camera_uri() == header.rig.camera_uri;
  }
  return preflight.camera_serial() == header.camera.serial;
}

// Of the plan, the first exposure of light that the preflight did not look at; 0 if it saw all.
double UncheckedExposure(const v1::PreflightResult& preflight, const CapturePlan& plan) {
  const auto& seen = preflight.exposures_s();
  for (const CaptureSpec& spec : plan.captures) {
    if (spec.kind != FrameKind::kLight) continue;
    const auto same = [&spec](double exposure_s) {
      return std::abs(exposure_s / spec.exposure_s - 1) < 1e-6;
    };
    if (std::none_of(seen.begin(), seen.end(), same)) return spec.exposure_s;
  }
  return 0;
}

// A file that says nothing of any check proves nothing.
bool Passed(const v1::PreflightResult& preflight) {
  return preflight.passed() && preflight.checks_size() > 0 &&
         NamesWith(preflight, v1::CHECK_VERDICT_FAILED).empty() &&
         NamesWith(preflight, v1::CHECK_VERDICT_UNSPECIFIED).empty();
}

}  // namespace

Certification CertificationOf(const std::filesystem::path& recording,
                              const capture::RecordingHeader& header) {
  v1::PreflightResult preflight;
  const absl::Status read = ReadJson(recording / kPreflightFile, preflight);
  if (absl::IsNotFound(read)) {
    return {false, "no preflight stands beside the recording: run eyebox preflight on the rig"};
  }
  if (!read.ok()) return {false, absl::StrCat(kPreflightFile, " cannot be read")};
  if (!SameCamera(preflight, header)) {
    return {false, absl::StrCat("the preflight is of another camera, '", preflight.camera_uri(),
                                "' ", preflight.camera_serial())};
  }
  if (!Passed(preflight)) {
    return {false,
            absl::StrCat("the preflight failed: ", NamesWith(preflight, v1::CHECK_VERDICT_FAILED))};
  }
  if (const double exposure_s = UncheckedExposure(preflight, header.plan); exposure_s > 0) {
    return {false, absl::StrFormat("the preflight did not look at the exposure of %g s: give it "
                                   "with --exposures",
                                   exposure_s)};
  }
  const std::string skipped = NamesWith(preflight, v1::CHECK_VERDICT_SKIPPED);
  return {true, skipped.empty() ? "the preflight passed"
                                : absl::StrCat("the preflight passed; not checked: ", skipped)};
}

absl::Status WritePreflight(const std::filesystem::path& folder,
                            const v1::PreflightResult& result) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  return WriteFileAtomically(folder / kPreflightFile, json);
}

absl::StatusOr<v1::PreflightResult> ReadPreflight(const std::filesystem::path& place) {
  std::error_code absent;
  const bool folder = std::filesystem::is_directory(place, absent);
  v1::PreflightResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(folder ? place / kPreflightFile : place, result));
  return result;
}

}  // namespace eyebox::service
