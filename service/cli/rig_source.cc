#include "service/cli/rig_source.h"

#include <algorithm>

#include "capture/base/status.h"
#include "capture/recording/rig_file.h"

namespace eyebox::service::cli {
namespace {

// A resource name for what a URI names: [a-z0-9-], at most 63 characters.
std::string NameFor(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (!(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9')) c = '-';
  }
  name.erase(0, name.find_first_not_of('-'));
  return name.empty() ? "rig" : name.substr(0, 63);
}

}  // namespace

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
  return capture::RigConfig{.name = NameFor(source.substr(colon + 1)), .camera_uri = source};
}

}  // namespace eyebox::service::cli
