#include "capture/recording/export.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <set>
#include <utility>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/base/unix_file.h"
#include "capture/recording/grey_tiff.h"
#include "capture/recording/reader.h"
#include "capture/recording/staging.h"

namespace eyebox::capture {
namespace {

constexpr const char* kColumns =
    "file,kind,exposure_s,gain_db,series,repeat,pattern,diameter_deg,drive_r,drive_g,drive_b,"
    "luminance_cd_m2,luminance_relative_sigma,timestamp_s,photodiode_counts,bits\n";

std::string KindName(FrameKind kind) {
  switch (kind) {
    case FrameKind::kLight:
      return "light";
    case FrameKind::kDark:
      return "dark";
    case FrameKind::kFlat:
      return "flat";
  }
  return "";
}

std::string PatternName(StimulusPattern pattern) {
  switch (pattern) {
    case StimulusPattern::kFullField:
      return "full_field";
    case StimulusPattern::kDisk:
      return "disk";
    case StimulusPattern::kBlackDisk:
      return "black_disk";
    case StimulusPattern::kCheckerboard:
      return "checkerboard";
  }
  return "";
}

template <typename... Values>
std::string Format(const char* format, Values... values) {
  std::string text(64, '\0');
  text.resize(static_cast<size_t>(std::snprintf(text.data(), text.size(), format, values...)));
  return text;
}

std::string Number(double value) { return Format("%.17g", value); }

std::string Known(const std::optional<double>& value) { return value ? Number(*value) : ""; }

std::string Seconds(int64_t time_ns) {
  const uint64_t size_ns = time_ns < 0 ? -static_cast<uint64_t>(time_ns) : time_ns;
  return Format("%s%" PRIu64 ".%09" PRIu64, time_ns < 0 ? "-" : "", size_ns / 1'000'000'000,
                size_ns % 1'000'000'000);
}

std::string Timestamp(const FrameMetadata& metadata) {
  if (metadata.monotonic_time_ns != 0) return Seconds(metadata.monotonic_time_ns);
  return metadata.device_time_ns ? Seconds(*metadata.device_time_ns) : "";
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string DriveColumns(const std::optional<DriveRgb>& drive) {
  if (!drive) return ",,";
  return Number((*drive)[0]) + "," + Number((*drive)[1]) + "," + Number((*drive)[2]);
}

bool Passes(const CaptureSpec& spec, const ExportFilter& filter) {
  return (!filter.kind || *filter.kind == spec.kind) &&
         (!filter.series || *filter.series == spec.series);
}

// What import groups frames by.
CaptureSpec GroupOf(CaptureSpec spec) {
  spec.level_id = -1;
  spec.repeats = 1;
  return spec;
}

class Exporter {
 public:
  Exporter(RecordingReader& reader, std::filesystem::path folder)
      : reader_(reader), folder_(std::move(folder)) {}

  absl::Status Export(const CaptureEntry& capture) {
    long& repeat = RepeatOf(GroupOf(capture.spec));
    int in_capture = 0;
    const absl::Status visited = reader_.VisitFrames(capture, [&](const Frame& frame) {
      const std::string name = Format("%06d-%05d.tiff", capture.number, ++in_capture);
      AddRow(name, capture.spec, ++repeat, frame.metadata);
      ++report_.frames;
      return Write(folder_ / name, frame.view);
    });
    ++report_.captures;
    return visited;
  }

  absl::Status WriteIndex() const { return WriteFileAtomically(folder_ / "index.csv", index_); }
  const ExportReport& report() const { return report_; }

 private:
  static absl::Status Write(const std::filesystem::path& name, const FrameView& frame) {
    EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, EncodeGreyTiff16(frame));
    EYEBOX_ASSIGN_OR_RETURN(UnixFile file, UnixFile::Create(name));
    EYEBOX_RETURN_IF_ERROR(file.WriteAt(0, bytes.data(), bytes.size()));
    return file.Sync();
  }

  long& RepeatOf(const CaptureSpec& group) {
    const auto known = std::ranges::find(repeats_, group, &std::pair<CaptureSpec, long>::first);
    return known != repeats_.end() ? known->second : repeats_.emplace_back(group, 0).second;
  }

  void AddRow(const std::string& name, const CaptureSpec& spec, long repeat,
              const FrameMetadata& metadata) {
    const Stimulus& stimulus = spec.stimulus;
    for (const std::string& field :
         {name, KindName(spec.kind), Number(spec.exposure_s), Number(spec.gain_db),
          Quoted(spec.series), std::to_string(repeat), PatternName(stimulus.pattern),
          stimulus.diameter_deg == 0 ? "" : Number(stimulus.diameter_deg),
          DriveColumns(stimulus.drive), Known(spec.luminance_cd_m2),
          Known(spec.luminance_relative_sigma), Timestamp(metadata),
          Known(metadata.photodiode_counts)}) {
      index_ += field + ",";
    }
    index_ += std::to_string(reader_.Header().camera.significant_bits) + "\n";
  }

  RecordingReader& reader_;
  const std::filesystem::path folder_;
  std::string index_ = kColumns;
  std::vector<std::pair<CaptureSpec, long>> repeats_;  // used so far, by group
  ExportReport report_;
};

absl::StatusOr<std::vector<const CaptureEntry*>> Select(const std::filesystem::path& recording,
                                                        const RecordingReader& reader,
                                                        const ExportFilter& filter) {
  std::vector<const CaptureEntry*> selected;
  std::set<std::string> known;
  for (const CaptureEntry& capture : reader.Captures()) {
    known.insert(KindName(capture.spec.kind) + " '" + capture.spec.series + "'");
    if (!Passes(capture.spec, filter)) continue;
    if (capture.spec.series.find_first_of("\r\n") != std::string::npos) {
      return BadInput(capture.file.string(), "is of a series with a line break in its name",
                      "leave it out by --series");
    }
    selected.push_back(&capture);
  }
  if (!selected.empty()) return selected;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  return Missing(recording.string(), "holds no such frames",
                 "choose kind and series from: " + (list.empty() ? "nothing" : list));
}

}  // namespace

absl::StatusOr<ExportReport> ExportTiff(const std::filesystem::path& recording,
                                        const std::filesystem::path& folder,
                                        const ExportFilter& filter,
                                        const ExportProgress& progress) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, RecordingReader::Open(recording));
  EYEBOX_ASSIGN_OR_RETURN(const auto captures, Select(recording, *reader, filter));
  EYEBOX_ASSIGN_OR_RETURN(StagedFolder staged, StagedFolder::Begin(folder));
  Exporter exporter(*reader, staged.path());
  for (const CaptureEntry* capture : captures) {
    EYEBOX_RETURN_IF_ERROR(exporter.Export(*capture));
    if (progress) progress(exporter.report().captures, static_cast<int>(captures.size()));
  }
  EYEBOX_RETURN_IF_ERROR(exporter.WriteIndex());
  EYEBOX_RETURN_IF_ERROR(staged.Commit());
  return exporter.report();
}

}  // namespace eyebox::capture
