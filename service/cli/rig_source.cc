#include "service/cli/rig_source.h"

#include <algorithm>

#include "capture/base/status.h"
#include "capture/recording/rig_file.h"

namespace eyebox::service::cli {

absl::StatusOr<capture::RigConfig> RigOf(const std::string& source) {
  if (source.ends_with(".textproto")) return capture::ReadRigFile(source);
  const size_t colon = source.find(':');
  const auto schemes = capture::CameraSchemes();
  if (colon == std::string::npos ||
      std::find(schemes.begin(), schemes.end(), source.substr(0, colon)) == schemes.end()) {
    return Missing(source, "no such recording or rig",
                   "give the folder of a recording, a rig file (.textproto) or a camera like "
                   "sim:rift-s-like");
  }
  if (source.starts_with("replay:")) {
    return BadInput(source, "is a recording", "use eyebox replay " + source.substr(colon + 1));
  }
  return capture::RigConfig{.name = source.substr(colon + 1), .camera_uri = source};
}

}  // namespace eyebox::service::cli
