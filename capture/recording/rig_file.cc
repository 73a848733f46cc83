#include "capture/recording/rig_file.h"

#include <string>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/convert.h"
#include "capture/recording/text_format.h"

namespace eyebox::capture {
namespace {

constexpr size_t kLargestRigFile = size_t{1} << 20;

absl::Status CheckScheme(const std::string& where, const std::string& uri) {
  std::string known;
  for (const std::string& scheme : CameraSchemes()) {
    if (uri.starts_with(scheme + ":")) return absl::OkStatus();
    known += " " + scheme + ":";
  }
  return BadInput(where + " camera_uri", "is '" + uri + "', of no scheme that is known here",
                  "start it with one of" + known);
}

}  // namespace

absl::StatusOr<RigConfig> ReadRigFile(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestRigFile));
  v1::Rig proto;
  EYEBOX_RETURN_IF_ERROR(ParseText(text, file, proto));
  EYEBOX_ASSIGN_OR_RETURN(RigConfig rig, FromProto(proto, file.string()));
  EYEBOX_RETURN_IF_ERROR(CheckScheme(file.string(), rig.camera_uri));
  return rig;
}

}  // namespace eyebox::capture
