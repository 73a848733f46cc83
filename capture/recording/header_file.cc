#include "capture/recording/header_file.h"

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/base/version.h"
#include "capture/recording/checksum.h"
#include "capture/recording/convert.h"
#include "capture/recording/layout.h"
#include "capture/recording/text_format.h"

namespace eyebox::capture {
namespace {

constexpr size_t kLargestHeader = size_t{16} << 20;

}  // namespace

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

absl::StatusOr<RecordingHeader> ReadHeader(const std::filesystem::path& recording,
                                           const Manifest& manifest) {
  const std::filesystem::path file = HeaderPath(recording);
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(file, kLargestHeader));
  if (text.size() != manifest.header_bytes || Checksum(text) != manifest.header_xxh3) {
    return Corrupt(file.string(), "is not what was written: it does not match manifest.log",
                   "restore it from a copy; it must not be edited");
  }
  return ParseHeader(text, file);
}

MetaStrings CaptureMeta(const CameraInfo& camera, const CaptureSpec& spec) {
  return {{"format", "eyebox capture " + std::to_string(kFormatVersion)},
          {"software_version", std::string(kVersion)},
          {"camera", PrintText(ToProto(camera))},
          {"capture", PrintText(ToProto(spec))}};
}

}  // namespace eyebox::capture
