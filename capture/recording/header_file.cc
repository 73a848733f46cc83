#include "capture/recording/header_file.h"

#include "capture/base/status.h"
#include "capture/base/version.h"
#include "capture/recording/convert.h"
#include "capture/recording/layout.h"
#include "capture/recording/text_format.h"

namespace eyebox::capture {

absl::StatusOr<std::string> HeaderText(const RecordingHeader& header) {
  const v1::Recording proto = ToProto(header);
  EYEBOX_RETURN_IF_ERROR(FromProto(proto, "recording header").status());
  return PrintText(proto);
}

absl::StatusOr<RecordingHeader> ParseHeader(const std::string& text,
                                            const std::filesystem::path& file) {
  v1::Recording proto;
  EYEBOX_RETURN_IF_ERROR(ParseText(text, file, proto));
  return FromProto(proto, file.string());
}

MetaStrings CaptureMeta(const CameraInfo& camera, const CaptureSpec& spec) {
  return {{"format", "eyebox capture " + std::to_string(kFormatVersion)},
          {"software_version", std::string(kVersion)},
          {"camera", PrintText(ToProto(camera))},
          {"capture", PrintText(ToProto(spec))}};
}

}  // namespace eyebox::capture
