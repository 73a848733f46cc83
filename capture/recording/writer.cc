#include "capture/recording/writer.h"

#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>
#include <utility>

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

using Path = std::filesystem::path;

// What HDF5 takes beside frames and records, and a reserve for manifest and results.
constexpr double kSpareBytes = 1 << 20;

std::string Megabytes(double bytes) { return std::to_string(bytes / 1e6) + " MB"; }

// In double: a plan may ask for more bytes than 64 bits count.
double NeededBytes(const ManifestEntry& entry) {
  return static_cast<double>(entry.FrameBytes() + sizeof(FrameRecord)) *
             static_cast<double>(entry.row_count) +
         static_cast<double>(entry.side.sample_capacity) * sizeof(SampleRow) +
         static_cast<double>(entry.side.group_capacity) * sizeof(SampleGroup) + kSpareBytes;
}

absl::Status DiskFull(const absl::Status& refused, const ManifestEntry& entry) {
  return absl::ResourceExhaustedError(std::string(refused.message()) + " (the next capture needs " +
                                      Megabytes(NeededBytes(entry)) + ")");
}

absl::Status CheckSpace(const Path& folder, const ManifestEntry& entry) {
  struct statvfs state {};
  if (::statvfs(folder.c_str(), &state) != 0) {
    return SystemFailed(folder.string(), errno, "check the path");
  }
  const double free = static_cast<double>(state.f_bavail) * static_cast<double>(state.f_frsize);
  if (NeededBytes(entry) <= free) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      Complaint(folder.string(),
                "needs " + Megabytes(NeededBytes(entry)) + " for the next capture, " +
                    Megabytes(free) + " are free",
                "free space, use another disk or plan fewer frames"));
}

// What captures share: the folder, the manifest, whether either may still be written.
struct Book {
  Path recording;
  CameraInfo camera;
  ManifestLog manifest;
  int published = 0;
  bool capture_open = false;
  bool failed = false;  // the manifest may end within a record
};

class FileCapture final : public CaptureWriter {
 public:
  FileCapture(std::shared_ptr<Book> book, ManifestEntry entry, UnixFile file)
      : book_(std::move(book)),
        entry_(std::move(entry)),
        file_(std::move(file)),
        side_(entry_.side) {
    book_->capture_open = true;
  }
  ~FileCapture() override { book_->capture_open = false; }

  absl::Status Append(const Frame& frame) override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(CheckFrame(frame));
    const uint64_t index = appended_;
    const FrameRecord record =
        MakeFrameRecord(frame, static_cast<uint32_t>(index), entry_.spec.level_id);
    EYEBOX_RETURN_IF_ERROR(
        Remember(file_.WriteAt(entry_.FrameOffset(index), frame.view.pixels_dn.data(),
                               frame.view.pixels_dn.size_bytes())));
    EYEBOX_RETURN_IF_ERROR(
        Remember(file_.WriteAt(entry_.RecordOffset(index), &record, sizeof(record))));
    file_.StartWriting(entry_.FrameOffset(index), entry_.FrameBytes());
    ++appended_;
    return absl::OkStatus();
  }

  absl::Status AppendSamples(const SampleBlock& block) override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(SideWriter::Check(block, file_));
    return Remember(side_.Append(block, file_));
  }

  absl::Status AppendClockTriple(const ClockTriple& triple) override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(side_.CheckRoomForTriple(file_));
    return Remember(side_.Append(triple, file_));
  }

  int64_t samples_lost() const override { return static_cast<int64_t>(side_.rows().samples_lost); }

  absl::Status Acknowledge() override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(Remember(side_.CloseGroup(file_)));
    EYEBOX_RETURN_IF_ERROR(Remember(file_.SyncData()));
    acknowledged_ = appended_;
    return absl::OkStatus();
  }

  absl::Status Publish() override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(CheckAcknowledged(static_cast<uint64_t>(entry_.row_count)));
    return PublishAcknowledged();
  }

  absl::Status PublishEarly() override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    EYEBOX_RETURN_IF_ERROR(CheckAcknowledged(std::max(appended_, uint64_t{1})));
    return PublishAcknowledged();
  }

 private:
  absl::Status PublishAcknowledged() {
    // Samples and triples may have come since the last acknowledgement: Sync() below covers them.
    EYEBOX_RETURN_IF_ERROR(Remember(side_.CloseGroup(file_)));
    entry_.frame_count = static_cast<int>(acknowledged_);
    entry_.side = side_.rows();
    EYEBOX_ASSIGN_OR_RETURN(entry_.digest_xxh3, DigestOf(file_, entry_));
    EYEBOX_RETURN_IF_ERROR(Remember(file_.Sync()));
    EYEBOX_RETURN_IF_ERROR(
        Remember(RenameDurably(file_.path(), CapturePath(book_->recording, entry_.number))));
    closed_ = true;
    const absl::Status status = book_->manifest.Append(entry_);
    if (status.ok()) ++book_->published;
    book_->failed |= !status.ok();
    return status;
  }

  absl::Status CheckUsable() const {
    const std::string where = file_.path().string();
    if (closed_) return Rejected(where, "is published already", "begin another capture");
    if (failed_) return Rejected(where, "failed before", "begin the capture again");
    return absl::OkStatus();
  }

  // After an error of the disk the file is abandoned.
  absl::Status Remember(absl::Status status) {
    failed_ |= !status.ok();
    return status;
  }

  absl::Status CheckFrame(const Frame& frame) const {
    const std::string where = file_.path().string() + ", frame " + std::to_string(appended_);
    if (frame.metadata.status != BufferStatus::kComplete) {
      return Rejected(where, "is not complete", "capture it again: it is not data");
    }
    if (frame.view.size != entry_.frame_size ||
        frame.view.pixels_dn.size() != entry_.frame_size.PixelCount()) {
      return BadInput(where,
                      "is " + std::to_string(frame.view.size.width_px) + " x " +
                          std::to_string(frame.view.size.height_px) + " px, the capture is of " +
                          std::to_string(entry_.frame_size.width_px) + " x " +
                          std::to_string(entry_.frame_size.height_px) + " px",
                      "keep the frame size within a capture");
    }
    if (appended_ >= static_cast<uint64_t>(entry_.row_count)) {
      return BadInput(where, "is one more than the capture was announced with",
                      "announce as many repeats as are taken");
    }
    return absl::OkStatus();
  }

  absl::Status CheckAcknowledged(uint64_t expected) const {
    if (acknowledged_ == expected) return absl::OkStatus();
    return Rejected(file_.path().string(),
                    "has " + std::to_string(acknowledged_) + " acknowledged frames of " +
                        std::to_string(expected),
                    "append and acknowledge all of them first");
  }

  const std::shared_ptr<Book> book_;
  ManifestEntry entry_;
  UnixFile file_;
  SideWriter side_;
  uint64_t appended_ = 0;
  uint64_t acknowledged_ = 0;
  bool closed_ = false;
  bool failed_ = false;
};

class FileRecording final : public RecordingWriter {
 public:
  explicit FileRecording(Book book) : book_(std::make_shared<Book>(std::move(book))) {}

  using RecordingWriter::BeginCapture;
  absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec& spec,
                                                              ImageSize frame_size,
                                                              const SideRoom& room) override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    ManifestEntry entry;
    entry.number = book_->published + 1;
    entry.spec = spec;
    entry.frame_size = frame_size;
    entry.frame_count = entry.row_count = spec.repeats;
    const Path partial = PartialPath(book_->recording, entry.number);
    EYEBOX_RETURN_IF_ERROR(CheckShape(partial, entry));
    EYEBOX_RETURN_IF_ERROR(CheckRoom(partial, room));
    entry.side = RowsFor(room, spec.repeats);
    // A capture that is taken again begins anew, and its space counts as free.
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    EYEBOX_RETURN_IF_ERROR(CheckSpace(CapturesFolder(book_->recording), entry));
    absl::StatusOr<UnixFile> file = Prepare(partial, entry);
    if (!file.ok()) {
      ::unlink(partial.c_str());
      if (!absl::IsResourceExhausted(file.status())) return std::move(file).status();
      return DiskFull(file.status(), entry);  // a quota, or another program was faster
    }
    EYEBOX_RETURN_IF_ERROR(NoteBegun(*file, entry));
    return std::make_unique<FileCapture>(book_, std::move(entry), *std::move(file));
  }

  absl::Status SuspectSince(int first, const std::string& reason) override {
    EYEBOX_RETURN_IF_ERROR(CheckUsable());
    if (first < 1 || first > book_->published || reason.empty()) {
      return BadInput(book_->recording.string(),
                      "capture " + std::to_string(first) + " cannot be suspected",
                      "name a published capture and the reason");
    }
    const absl::Status status = book_->manifest.Append(
        SuspectCaptures{.first = first, .last = book_->published, .reason = reason});
    book_->failed |= !status.ok();
    return status;
  }

  int PublishedCount() const override { return book_->published; }

 private:
  absl::Status CheckUsable() const {
    const std::string where = book_->recording.string();
    if (book_->capture_open) {
      return Rejected(where, "has a capture open", "publish or drop it first");
    }
    if (book_->failed) {
      return Rejected(where, "could not write its manifest before", "begin another recording");
    }
    return absl::OkStatus();
  }

  static absl::Status CheckShape(const Path& partial, const ManifestEntry& entry) {
    if (entry.frame_count < 1) {
      return BadInput(partial.string(),
                      "is to hold " + std::to_string(entry.frame_count) + " frames",
                      "ask for one or more");
    }
    if (entry.frame_size.width_px > 0 && entry.frame_size.height_px > 0) return absl::OkStatus();
    return BadInput(partial.string(), "is to hold frames without pixels", "give the frame size");
  }

  static absl::Status CheckRoom(const Path& partial, const SideRoom& room) {
    constexpr int64_t kMostSamples = int64_t{1} << 40;  // beyond any disk, within 64 bits of bytes
    if (room.samples >= 0 && room.samples <= kMostSamples && room.clock_triples >= 0) {
      return absl::OkStatus();
    }
    return BadInput(partial.string(),
                    "is to have room for " + std::to_string(room.samples) + " samples and " +
                        std::to_string(room.clock_triples) + " clock triples",
                    "give none or more of each");
  }

  static SideRows RowsFor(const SideRoom& room, int frames) {
    // One group an acknowledgement: a few more than one after every frame.
    constexpr uint64_t kMoreGroups = 16;
    SideRows rows;
    rows.sample_capacity = static_cast<uint64_t>(room.samples);
    if (room.samples > 0) rows.group_capacity = static_cast<uint64_t>(frames) + kMoreGroups;
    rows.triple_capacity = static_cast<uint64_t>(room.clock_triples);
    return rows;
  }

  // libhdf5 has closed the file when its space is reserved.
  absl::StatusOr<UnixFile> Prepare(const Path& partial, ManifestEntry& entry) {
    EYEBOX_ASSIGN_OR_RETURN(
        const CaptureFileLayout layout,
        CreateCaptureFile(partial, {entry.frame_size, entry.frame_count, entry.side},
                          CaptureMeta(book_->camera, entry.spec)));
    entry.file_bytes = layout.file_bytes;
    entry.frames_offset_bytes = layout.frames_offset_bytes;
    entry.records_offset_bytes = layout.records_offset_bytes;
    entry.side = layout.side;
    EYEBOX_ASSIGN_OR_RETURN(UnixFile file, UnixFile::OpenToWrite(partial));
    EYEBOX_RETURN_IF_ERROR(file.Reserve(layout.file_bytes));
    EYEBOX_RETURN_IF_ERROR(file.Sync());
    EYEBOX_RETURN_IF_ERROR(SyncFolder(partial.parent_path()));
    return file;
  }

  // What recovery needs to trust a file that was never published.
  absl::Status NoteBegun(const UnixFile& file, const ManifestEntry& entry) {
    BegunCapture begun = {.entry = entry};
    EYEBOX_ASSIGN_OR_RETURN(begun.structure_xxh3, StructureOf(file, entry));
    const absl::Status status = book_->manifest.Append(begun);
    book_->failed |= !status.ok();
    return status;
  }

  const std::shared_ptr<Book> book_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<RecordingWriter>> RecordingWriter::Create(
    const Path& recording, const RecordingHeader& header, const Clock*) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string text, HeaderText(header));
  EYEBOX_RETURN_IF_ERROR(CheckVacant(recording));
  EYEBOX_RETURN_IF_ERROR(CreateFolders(CapturesFolder(recording)));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(HeaderPath(recording), text));
  EYEBOX_ASSIGN_OR_RETURN(ManifestLog manifest, ManifestLog::Create(ManifestPath(recording), text));
  EYEBOX_RETURN_IF_ERROR(SyncFolder(recording.parent_path()));
  return std::make_unique<FileRecording>(
      Book{.recording = recording, .camera = header.camera, .manifest = std::move(manifest)});
}

absl::StatusOr<std::unique_ptr<RecordingWriter>> RecordingWriter::Resume(const Path& recording) {
  EYEBOX_RETURN_IF_ERROR(RecordingReader::Open(recording).status());
  ManifestScan scan;
  EYEBOX_ASSIGN_OR_RETURN(ManifestLog manifest, ManifestLog::Open(ManifestPath(recording), scan));
  EYEBOX_RETURN_IF_ERROR(scan.rest);
  const int published = static_cast<int>(scan.manifest.entries.size());
  for (const Path& file :
       {PartialPath(recording, published + 1), CapturePath(recording, published + 1)}) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    return Rejected(file.string(), "is of a capture that was interrupted",
                    "run eyebox recover " + recording.string() + " first");
  }
  EYEBOX_ASSIGN_OR_RETURN(const RecordingHeader header, ReadHeader(recording, scan.manifest));
  return std::make_unique<FileRecording>(Book{.recording = recording,
                                              .camera = header.camera,
                                              .manifest = std::move(manifest),
                                              .published = published});
}

}  // namespace eyebox::capture
