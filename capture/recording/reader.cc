#include "capture/recording/reader.h"

#include <system_error>
#include <utility>
#include <vector>

#include "capture/base/status.h"
#include "capture/base/unix_file.h"
#include "capture/recording/capture_file.h"
#include "capture/recording/frame_record.h"
#include "capture/recording/header_file.h"
#include "capture/recording/layout.h"
#include "capture/recording/manifest.h"
#include "capture/recording/side_file.h"

namespace eyebox::capture {
namespace {

constexpr const char* kRestore = "restore it from a copy or capture it again";

// Everything but the pixels of an unpacked file, which their records vouch for.
absl::Status CheckDigest(const UnixFile& file, const ManifestEntry& entry) {
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t size, file.Size());
  if (size != entry.file_bytes) {
    return Corrupt(
        file.path().string(),
        "has " + std::to_string(size) + " bytes instead of " + std::to_string(entry.file_bytes),
        kRestore);
  }
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t digest, DigestOf(file, entry));
  if (digest == entry.digest_xxh3) return absl::OkStatus();
  return Corrupt(file.path().string(), "is damaged: it does not match manifest.log", kRestore);
}

absl::StatusOr<UnixFile> OpenCapture(const std::filesystem::path& file) {
  absl::StatusOr<UnixFile> opened = UnixFile::OpenToRead(file);
  if (!absl::IsNotFound(opened.status())) return opened;
  return Corrupt(file.string(), "is missing, though manifest.log names it", kRestore);
}

class FileReader final : public RecordingReader {
 public:
  FileReader(const std::filesystem::path& recording, RecordingHeader header, Manifest manifest)
      : header_(std::move(header)), manifest_(std::move(manifest)) {
    for (const ManifestEntry& entry : manifest_.entries) {
      captures_.push_back({.number = entry.number,
                           .spec = entry.spec,
                           .frame_size = entry.frame_size,
                           .frame_count = entry.frame_count,
                           .packed = entry.packed,
                           .file = CapturePath(recording, entry.number),
                           .suspect = entry.suspect,
                           .sample_count = static_cast<int64_t>(entry.side.sample_count),
                           .samples_lost = static_cast<int64_t>(entry.side.samples_lost)});
    }
  }

  const RecordingHeader& Header() const override { return header_; }
  std::span<const CaptureEntry> Captures() const override { return captures_; }

  absl::Status VisitFrames(const CaptureEntry& capture, const FrameVisitor& visit) override {
    const ManifestEntry& entry = EntryOf(capture);
    EYEBOX_ASSIGN_OR_RETURN(const UnixFile file, OpenVerified(capture));
    std::unique_ptr<PackedFrames> packed;
    if (entry.packed) {
      EYEBOX_ASSIGN_OR_RETURN(
          packed, PackedFrames::Open(capture.file, {entry.frame_size, entry.row_count}));
    }
    pixels_dn_.resize(entry.frame_size.PixelCount());
    int shown = 0;
    for (uint32_t row = 0; row < static_cast<uint32_t>(entry.row_count); ++row) {
      EYEBOX_ASSIGN_OR_RETURN(const FrameRecord record, ReadRecord(file, entry, row));
      if (entry.row_count > entry.frame_count && IsEmpty(record)) continue;
      EYEBOX_RETURN_IF_ERROR(
          packed ? packed->Read(static_cast<int>(row), pixels_dn_)
                 : file.ReadAt(entry.FrameOffset(row), pixels_dn_.data(), entry.FrameBytes()));
      EYEBOX_RETURN_IF_ERROR(Show(file, entry, row, record, visit));
      ++shown;
    }
    if (shown == entry.frame_count) return absl::OkStatus();
    return Corrupt(file.path().string(),
                   "holds " + std::to_string(shown) + " frames instead of " +
                       std::to_string(entry.frame_count),
                   kRestore);
  }

  absl::Status VisitSamples(const CaptureEntry& capture, const SampleVisitor& visit) override {
    const SideRows& rows = EntryOf(capture).side;
    if (rows.sample_capacity == 0) return absl::OkStatus();
    EYEBOX_ASSIGN_OR_RETURN(const UnixFile file, OpenVerified(capture));
    return VisitSideSamples(file, rows, visit);
  }

  absl::StatusOr<std::vector<ClockTriple>> ClockTriples(const CaptureEntry& capture) override {
    const SideRows& rows = EntryOf(capture).side;
    if (rows.triple_capacity == 0) return std::vector<ClockTriple>();
    EYEBOX_ASSIGN_OR_RETURN(const UnixFile file, OpenVerified(capture));
    return ReadTriples(file, rows);
  }

 private:
  const ManifestEntry& EntryOf(const CaptureEntry& capture) const {
    return manifest_.entries.at(static_cast<size_t>(capture.number) - 1);
  }

  absl::StatusOr<UnixFile> OpenVerified(const CaptureEntry& capture) const {
    EYEBOX_ASSIGN_OR_RETURN(UnixFile file, OpenCapture(capture.file));
    EYEBOX_RETURN_IF_ERROR(CheckDigest(file, EntryOf(capture)));
    return file;
  }

  static absl::StatusOr<FrameRecord> ReadRecord(const UnixFile& file, const ManifestEntry& entry,
                                                uint32_t row) {
    FrameRecord record;
    EYEBOX_RETURN_IF_ERROR(file.ReadAt(entry.RecordOffset(row), &record, sizeof(record)));
    return record;
  }

  absl::Status Show(const UnixFile& file, const ManifestEntry& entry, uint32_t row,
                    const FrameRecord& record, const FrameVisitor& visit) {
    const std::string where = file.path().string() + ", frame " + std::to_string(row);
    EYEBOX_RETURN_IF_ERROR(CheckRecord(record, row, pixels_dn_, where));
    return visit({.metadata = MetadataOf(record),
                  .view = {.pixels_dn = pixels_dn_, .size = entry.frame_size},
                  .owner = nullptr});
  }

  const RecordingHeader header_;
  const Manifest manifest_;
  std::vector<CaptureEntry> captures_;
  std::vector<uint16_t> pixels_dn_;  // one frame
};

}  // namespace

absl::StatusOr<std::unique_ptr<RecordingReader>> RecordingReader::Open(
    const std::filesystem::path& recording) {
  std::error_code ignored;
  if (!std::filesystem::exists(ManifestPath(recording), ignored)) {
    if (std::filesystem::exists(HeaderPath(recording), ignored)) {
      return Corrupt(ManifestPath(recording).string(), "is missing", kRestore);
    }
    return Missing(recording.string(), "is not a recording: it holds no manifest.log",
                   "name the folder of a recording");
  }
  EYEBOX_ASSIGN_OR_RETURN(Manifest manifest, ReadManifest(ManifestPath(recording)));
  EYEBOX_ASSIGN_OR_RETURN(RecordingHeader header, ReadHeader(recording, manifest));
  for (const ManifestEntry& entry : manifest.entries) {
    EYEBOX_ASSIGN_OR_RETURN(const UnixFile file, OpenCapture(CapturePath(recording, entry.number)));
    if (!entry.packed) EYEBOX_RETURN_IF_ERROR(CheckDigest(file, entry));
  }
  return std::make_unique<FileReader>(recording, std::move(header), std::move(manifest));
}

}  // namespace eyebox::capture
