#include <set>
#include <string>
#include <system_error>

#include "capture/base/status.h"
#include "capture/recording/layout.h"
#include "capture/recording/manifest.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {
namespace {

using Names = std::set<std::filesystem::path>;

absl::StatusOr<Names> PublishedFiles(const std::filesystem::path& recording) {
  std::error_code error;
  Names names;
  for (const auto& file : std::filesystem::directory_iterator(CapturesFolder(recording), error)) {
    if (file.path().extension() == ".h5") names.insert(file.path());
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    return SystemFailed(CapturesFolder(recording).string(), error.value(), "check it");
  }
  return names;
}

// A published file that the manifest does not name: the manifest lost its end, or the machine
// stopped between renaming the file and naming it. A writer at work names it in a moment.
absl::Status CheckAllNamed(const std::filesystem::path& recording, const Names& files,
                           const RecordingReader& reader) {
  Names unnamed = files;
  for (const CaptureEntry& capture : reader.Captures()) unnamed.erase(capture.file);
  const int next = static_cast<int>(reader.Captures().size()) + 1;
  if (unnamed.contains(CapturePath(recording, next))) {
    EYEBOX_ASSIGN_OR_RETURN(const bool writing, IsBeingWritten(ManifestPath(recording)));
    EYEBOX_ASSIGN_OR_RETURN(const Manifest now, ReadManifest(ManifestPath(recording)));
    if (writing || static_cast<int>(now.entries.size()) >= next) {
      unnamed.erase(CapturePath(recording, next));
    }
  }
  if (unnamed.empty()) return absl::OkStatus();
  return Corrupt(unnamed.begin()->string(), "is not named by manifest.log",
                 "restore manifest.log from a copy; after a crash, eyebox recover enters the file");
}

}  // namespace

absl::StatusOr<VerifyReport> VerifyRecording(const std::filesystem::path& recording) {
  // Listed before the manifest is read: what is published afterwards is of no concern.
  EYEBOX_ASSIGN_OR_RETURN(const Names files, PublishedFiles(recording));
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, RecordingReader::Open(recording));
  VerifyReport report;
  for (const CaptureEntry& capture : reader->Captures()) {
    EYEBOX_RETURN_IF_ERROR(reader->VisitFrames(capture, [&report](const Frame&) {
      ++report.frames;
      return absl::OkStatus();
    }));
    EYEBOX_RETURN_IF_ERROR(reader->VisitSamples(capture, [&report](const SampleBlock& block) {
      report.samples += static_cast<int64_t>(block.samples.size());
      return absl::OkStatus();
    }));
    EYEBOX_RETURN_IF_ERROR(reader->ClockTriples(capture).status());
    std::error_code error;
    const auto size = std::filesystem::file_size(capture.file, error);
    if (error) return SystemFailed(capture.file.string(), error.value(), "check the disk");
    report.bytes += static_cast<int64_t>(size);
    ++report.captures;
  }
  EYEBOX_RETURN_IF_ERROR(CheckAllNamed(recording, files, *reader));
  return report;
}

}  // namespace eyebox::capture
