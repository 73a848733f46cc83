#include "capture/recording/pack.h"

#include <string>
#include <utility>
#include <vector>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/base/unix_file.h"
#include "capture/recording/capture_file.h"
#include "capture/recording/frame_record.h"
#include "capture/recording/header_file.h"
#include "capture/recording/layout.h"
#include "capture/recording/manifest.h"
#include "capture/recording/reader.h"
#include "capture/recording/side_file.h"
#include "capture/recording/staging.h"

namespace eyebox::capture {
namespace {

// Samples and triples are few: their bytes are copied as they are, with their room.
absl::Status CopySide(const CaptureEntry& capture, const SideRows& from_rows, UnixFile& to,
                      const SideRows& to_rows) {
  if (from_rows.Empty()) return absl::OkStatus();
  EYEBOX_ASSIGN_OR_RETURN(const UnixFile from, UnixFile::OpenToRead(capture.file));
  return CopySideRows(from, from_rows, to, to_rows);
}

absl::StatusOr<ManifestEntry> PackCapture(RecordingReader& reader, const CaptureEntry& capture,
                                          const SideRows& side, const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(
      const auto writer,
      PackedFileWriter::Create(file, {capture.frame_size, capture.frame_count, side},
                               CaptureMeta(reader.Header().camera, capture.spec)));
  std::vector<FrameRecord> records;
  EYEBOX_RETURN_IF_ERROR(reader.VisitFrames(capture, [&](const Frame& frame) {
    records.push_back(
        MakeFrameRecord(frame, static_cast<uint32_t>(records.size()), capture.spec.level_id));
    return writer->Append(frame.view.pixels_dn);
  }));
  EYEBOX_ASSIGN_OR_RETURN(const CaptureFileLayout layout, writer->Finish());
  EYEBOX_ASSIGN_OR_RETURN(UnixFile written, UnixFile::OpenToWrite(file));
  EYEBOX_RETURN_IF_ERROR(written.WriteAt(layout.records_offset_bytes, records.data(),
                                         records.size() * sizeof(FrameRecord)));
  EYEBOX_RETURN_IF_ERROR(CopySide(capture, side, written, layout.side));
  EYEBOX_RETURN_IF_ERROR(written.Sync());
  ManifestEntry entry;
  entry.number = capture.number;
  entry.spec = capture.spec;
  entry.frame_size = capture.frame_size;
  entry.frame_count = capture.frame_count;
  entry.row_count = capture.frame_count;
  entry.packed = true;
  entry.file_bytes = layout.file_bytes;
  entry.records_offset_bytes = layout.records_offset_bytes;
  entry.side = layout.side;
  EYEBOX_ASSIGN_OR_RETURN(entry.digest_xxh3, DigestOf(written, entry));
  return entry;
}

absl::StatusOr<int64_t> SizeOf(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const UnixFile opened, UnixFile::OpenToRead(file));
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t size, opened.Size());
  return static_cast<int64_t>(size);
}

// The header is copied as it is, so that it stays the one that was written at the start.
absl::StatusOr<ManifestLog> CopyHeader(const std::filesystem::path& from,
                                       const std::filesystem::path& to) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(HeaderPath(from)));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(HeaderPath(to), text));
  return ManifestLog::Create(ManifestPath(to), text);
}

}  // namespace

absl::StatusOr<PackReport> PackRecording(const std::filesystem::path& recording,
                                         const std::filesystem::path& packed,
                                         const PackProgress& progress) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, RecordingReader::Open(recording));
  EYEBOX_ASSIGN_OR_RETURN(const Manifest source, ReadManifest(ManifestPath(recording)));
  EYEBOX_ASSIGN_OR_RETURN(StagedFolder staged, StagedFolder::Begin(packed));
  EYEBOX_RETURN_IF_ERROR(CreateFolders(CapturesFolder(staged.path())));
  EYEBOX_ASSIGN_OR_RETURN(ManifestLog manifest, CopyHeader(recording, staged.path()));
  PackReport report;
  for (const CaptureEntry& capture : reader->Captures()) {
    const std::filesystem::path file = CapturePath(staged.path(), capture.number);
    const SideRows& side = source.entries.at(static_cast<size_t>(capture.number) - 1).side;
    EYEBOX_ASSIGN_OR_RETURN(const ManifestEntry entry, PackCapture(*reader, capture, side, file));
    EYEBOX_RETURN_IF_ERROR(manifest.Append(entry));
    if (!capture.suspect.empty()) {
      EYEBOX_RETURN_IF_ERROR(manifest.Append(
          SuspectCaptures{.first = entry.number, .last = entry.number, .reason = capture.suspect}));
    }
    EYEBOX_ASSIGN_OR_RETURN(const int64_t bytes_before, SizeOf(capture.file));
    report.bytes_before += bytes_before;
    report.bytes_after += static_cast<int64_t>(entry.file_bytes);
    report.frames += entry.frame_count;
    ++report.captures;
    if (progress) progress(report.captures, static_cast<int>(reader->Captures().size()));
  }
  EYEBOX_RETURN_IF_ERROR(SyncFolder(CapturesFolder(staged.path())));
  EYEBOX_RETURN_IF_ERROR(VerifyRecording(staged.path()).status());
  EYEBOX_RETURN_IF_ERROR(staged.Commit());
  return report;
}

}  // namespace eyebox::capture
