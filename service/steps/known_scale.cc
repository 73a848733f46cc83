#include "service/steps/known_scale.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "eyebox/v1/photometry.pb.h"
#include "service/result_json.h"

namespace eyebox::service {

absl::Status UseScale(const std::filesystem::path& file, optics::Calibration& calibration) {
  if (file.empty()) return absl::OkStatus();
  v1::PhotometryResult result;
  EYEBOX_RETURN_IF_ERROR(ReadJson(file, result));
  double scale = 0;
  for (const v1::Parameter& parameter : result.luminance().parameters()) {
    if (parameter.name() == "cd_m2_per_dn_per_s") scale = parameter.value();
  }
  const double relative_sigma = result.luminance().relative_sigma();
  if (!(scale > 0) || !(relative_sigma >= 0 && relative_sigma < 1)) {
    return BadInput(file.string(), "holds no luminance scale of a camera",
                    "give what eyebox photometry scale wrote");
  }
  if (!result.accepted()) {
    return Rejected(file.string(),
                    absl::StrCat("was not accepted: ", absl::StrJoin(result.reasons(), "; ")),
                    "measure the scale again");
  }
  if (calibration.flat && calibration.flat->luminance) {
    return Rejected(file.string(), "the recording's flat has a known luminance, which is a scale",
                    "leave out --scale");
  }
  calibration.luminance_of_one_dn_per_s = optics::KnownLuminance{scale, relative_sigma};
  return absl::OkStatus();
}

}  // namespace eyebox::service
