#include <set>
#include <string>
#include <system_error>

#include "capture/base/status.h"
#include "capture/recording/layout.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {
namespace {

// A published file that the manifest does not name: the manifest lost its end, or the machine
// stopped between renaming the file and naming it.
absl::Status CheckAllNamed(const std::filesystem::path& recording, const RecordingReader& reader) {
  std::set<std::filesystem::path> named;
  for (const CaptureEntry& capture : reader.Captures()) named.insert(capture.file.filename());
  std::error_code error;
  std::set<std::filesystem::path> unnamed;
  for (const auto& file : std::filesystem::directory_iterator(CapturesFolder(recording), error)) {
    const std::filesystem::path name = file.path().filename();
    if (name.extension() == ".h5" && !named.contains(name)) unnamed.insert(file.path());
  }
  if (error) return SystemFailed(CapturesFolder(recording).string(), error.value(), "check it");
  if (unnamed.empty()) return absl::OkStatus();
  return Corrupt(unnamed.begin()->string(), "is not named by manifest.log",
                 "restore manifest.log from a copy, or move the file away to do without it");
}

}  // namespace

absl::StatusOr<VerifyReport> VerifyRecording(const std::filesystem::path& recording) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, RecordingReader::Open(recording));
  VerifyReport report;
  for (const CaptureEntry& capture : reader->Captures()) {
    EYEBOX_RETURN_IF_ERROR(reader->VisitFrames(capture, [&report](const Frame&) {
      ++report.frames;
      return absl::OkStatus();
    }));
    std::error_code error;
    const auto size = std::filesystem::file_size(capture.file, error);
    if (error) return SystemFailed(capture.file.string(), error.value(), "check the disk");
    report.bytes += static_cast<int64_t>(size);
    ++report.captures;
  }
  EYEBOX_RETURN_IF_ERROR(CheckAllNamed(recording, *reader));
  return report;
}

}  // namespace eyebox::capture
