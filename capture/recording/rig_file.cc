#include "capture/recording/rig_file.h"

#include <string>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/photodiode/photodiode.h"
#include "capture/recording/convert.h"
#include "capture/recording/text_format.h"

namespace eyebox::capture {
namespace {

constexpr size_t kLargestRigFile = size_t{1} << 20;

absl::Status CheckScheme(const std::string& where, const std::string& uri,
                         const std::vector<std::string>& schemes) {
  std::string known;
  for (const std::string& scheme : schemes) {
    if (uri.starts_with(scheme + ":")) return absl::OkStatus();
    known += " " + scheme + ":";
  }
  return BadInput(where, "is '" + uri + "', of no scheme that is known here",
                  "start it with one of" + known);
}

absl::Status CheckTrigger(const std::string& where, const std::string& uri) {
  if (uri.starts_with("gpiochip") || uri.starts_with("sim:")) return absl::OkStatus();
  return BadInput(where, "is '" + uri + "', of no scheme that is known here",
                  "start it with gpiochipN: or sim:");
}

}  // namespace

absl::StatusOr<RigConfig> ReadRigFile(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestRigFile));
  v1::Rig proto;
  EYEBOX_RETURN_IF_ERROR(ParseText(text, file, proto));
  EYEBOX_ASSIGN_OR_RETURN(RigConfig rig, FromProto(proto, file.string()));
  const std::string where = file.string() + " ";
  EYEBOX_RETURN_IF_ERROR(CheckScheme(where + "camera_uri", rig.camera_uri, CameraSchemes()));
  if (!rig.photodiode_uri.empty()) {
    EYEBOX_RETURN_IF_ERROR(
        CheckScheme(where + "photodiode_uri", rig.photodiode_uri, PhotodiodeSchemes()));
  }
  if (!rig.trigger_uri.empty()) {
    EYEBOX_RETURN_IF_ERROR(CheckTrigger(where + "trigger_uri", rig.trigger_uri));
  }
  if (!rig.sensor.empty()) rig.sensor = (file.parent_path() / rig.sensor).string();
  return rig;
}

}  // namespace eyebox::capture
