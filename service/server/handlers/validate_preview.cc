#include "service/server/handlers/validate_preview.h"

#include <cmath>
#include <string>

#include "capture/base/status.h"
#include "service/server/handlers/validate_run.h"
#include "service/server/store/names.h"
#include "service/server/store/rig_names.h"

namespace eyebox::service {
namespace {

constexpr double kLongestExposureS = 10;
constexpr int kLeastWidthPx = 16;
constexpr int kMostWidthPx = 1024;

absl::Status ValidateSource(const v1::PreviewRequest& request) {
  if (request.has_rig()) return CheckName(kRigNameRule, "rig", request.rig()).status();
  if (request.has_simulated()) return ValidateRig(request.simulated());
  return BadField("source", "is missing", "give a rig, or a simulated one");
}

}  // namespace

absl::Status ValidatePreview(const v1::PreviewRequest& request) {
  const double exposure_s = request.exposure_s();
  if (!(exposure_s >= 0 && exposure_s <= kLongestExposureS)) {
    return BadField("exposure_s", "is " + std::to_string(exposure_s),
                    "give a time above 0, at most 10 s, or 0 for 0.02");
  }
  if (!std::isfinite(request.gain_db())) {
    return BadField("gain_db", "is not finite", "give a number");
  }
  const int width = request.most_width_px();
  if (width != 0 && (width < kLeastWidthPx || width > kMostWidthPx)) {
    return BadField("most_width_px", "is " + std::to_string(width),
                    "give 16 to 1024, or 0 for 320");
  }
  if (request.has_drive() && !(request.drive() >= 0 && request.drive() <= 1)) {
    return BadField("drive", "is " + std::to_string(request.drive()), "give 0 to 1");
  }
  return ValidateSource(request);
}

}  // namespace eyebox::service
