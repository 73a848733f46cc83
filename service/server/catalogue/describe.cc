#include "service/server/catalogue/describe.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "absl/strings/str_replace.h"
#include "capture/base/status.h"
#include "capture/recording/convert.h"
#include "capture/recording/layout.h"
#include "capture/recording/remaining.h"
#include "service/server/store/served.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxResults = 100;

// A capture that is under way or was given up.
bool HasUnpublished(const fs::path& recording) {
  std::error_code error;
  for (fs::directory_iterator file(capture::CapturesFolder(recording), error);
       !error && file != fs::directory_iterator(); file.increment(error)) {
    if (file->path().extension() == ".partial") return true;
  }
  return false;
}

v1::RecordingState StateOf(const fs::path& folder, const capture::RecordingReader& reader) {
  const bool whole =
      capture::RemainingCaptures(reader.Header().plan, reader.Captures()).captures.empty() &&
      !HasUnpublished(folder);
  return whole ? v1::RECORDING_STATE_COMPLETE : v1::RECORDING_STATE_PARTIAL;
}

// Sorted; without names that a client could not give.
std::set<std::string> ResultsOf(const fs::path& recording) {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(recording / "results", error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (entry->is_directory(error) && CheckName(kArtifactRule, "name", name).ok()) {
      names.insert(name);
    }
    if (names.size() > kMaxResults) names.erase(std::prev(names.end()));
  }
  return names;
}

void CountCaptures(std::span<const capture::CaptureEntry> captures, v1::RecordingEntry& entry) {
  std::set<std::string> series;
  std::set<DriveRgb> levels;
  int64_t frames = 0;
  uint64_t bytes = 0;
  for (const capture::CaptureEntry& one : captures) {
    frames += one.frame_count;
    series.insert(one.spec.series);
    if (one.spec.kind == FrameKind::kLight && one.spec.stimulus.drive) {
      levels.insert(*one.spec.stimulus.drive);
    }
    std::error_code error;
    const uint64_t size = fs::file_size(one.file, error);
    if (!error) bytes += size;
  }
  entry.set_captures(static_cast<int>(captures.size()));
  entry.set_frames(frames);
  entry.set_bytes(static_cast<int64_t>(bytes));
  *entry.mutable_series() = {series.begin(), series.end()};
  entry.set_levels(static_cast<int>(levels.size()));
}

}  // namespace

absl::StatusOr<OpenRecording> OpenNamed(const RootFolder& data, const std::string& field,
                                        const std::string& name) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string path, CheckName(kRecordingNameRule, field, name));
  auto folder = data.OpenFolder(path);
  if (!folder.ok()) return WithField(folder.status(), field);
  auto reader = capture::RecordingReader::Open(folder->Path());
  if (!reader.ok()) {
    return absl::Status(
        reader.status().code(),
        absl::StrReplaceAll(reader.status().message(), {{folder->Path().string(), name}}));
  }
  return OpenRecording{*std::move(folder), *std::move(reader)};
}

v1::RecordingEntry Describe(const std::string& name, const OpenRecording& recording) {
  v1::RecordingEntry entry;
  entry.set_name(name);
  *entry.mutable_header() = capture::ToProto(recording.reader->Header());
  entry.mutable_header()->clear_plan();
  CountCaptures(recording.reader->Captures(), entry);
  const fs::path folder = recording.folder.Path();
  entry.set_state(StateOf(folder, *recording.reader));
  const std::set<std::string> results = ResultsOf(folder);
  *entry.mutable_results() = {results.begin(), results.end()};
  return entry;
}

v1::RecordingEntry DescribeDamaged(const std::string& name, const absl::Status& problem) {
  v1::RecordingEntry entry;
  entry.set_name(name);
  entry.set_state(v1::RECORDING_STATE_DAMAGED);
  entry.set_problem(std::string(problem.message()));
  return entry;
}

}  // namespace eyebox::service
