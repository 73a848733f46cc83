#include "capture/recording/recover.h"

#include <string_view>
#include <system_error>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/base/unix_file.h"
#include "capture/recording/checksum.h"
#include "capture/recording/header_file.h"
#include "capture/recording/layout.h"
#include "capture/recording/manifest.h"
#include "capture/recording/recover_rows.h"
#include "capture/recording/side_file.h"

namespace eyebox::capture {
namespace {

using Path = std::filesystem::path;

bool Exists(const Path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

class Recovery {
 public:
  explicit Recovery(Path recording) : recording_(std::move(recording)) {}

  absl::Status Run() {
    EYEBOX_RETURN_IF_ERROR(CheckIsRecording());
    if (!Exists(ManifestPath(recording_))) EYEBOX_RETURN_IF_ERROR(BeginManifest());
    ManifestScan scan;
    {
      EYEBOX_ASSIGN_OR_RETURN(ManifestLog log, ManifestLog::Open(ManifestPath(recording_), scan));
      EYEBOX_RETURN_IF_ERROR(MendEnd(scan, log));
      if (scan.whole_bytes > 0) {
        EYEBOX_RETURN_IF_ERROR(ReadHeader(recording_, scan.manifest).status());
      }
      if (scan.manifest.begun) EYEBOX_RETURN_IF_ERROR(MendCapture(*scan.manifest.begun, log));
      EYEBOX_RETURN_IF_ERROR(MendUnbegun(static_cast<int>(scan.manifest.entries.size()) + 1));
    }
    if (scan.whole_bytes == 0) EYEBOX_RETURN_IF_ERROR(BeginManifest());
    EYEBOX_ASSIGN_OR_RETURN(report_.verified, VerifyRecording(recording_));
    return absl::OkStatus();
  }

  RecoverReport report() && { return std::move(report_); }

 private:
  absl::Status CheckIsRecording() const {
    if (Exists(HeaderPath(recording_))) return absl::OkStatus();
    return Missing(recording_.string(), "holds no recording.textproto: nothing was recorded there",
                   "name the folder of a recording");
  }

  bool HasNoCaptures() const {
    std::error_code error;
    return std::filesystem::is_empty(CapturesFolder(recording_), error) && !error;
  }

  // Killed before the manifest had its first record, a recording has no capture yet.
  absl::Status BeginManifest() {
    if (!HasNoCaptures()) {
      return Corrupt(ManifestPath(recording_).string(), "is lost, though there are captures",
                     "restore it from a copy");
    }
    EYEBOX_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(HeaderPath(recording_)));
    EYEBOX_RETURN_IF_ERROR(ParseHeader(text, HeaderPath(recording_)).status());
    return ManifestLog::Create(ManifestPath(recording_), text).status();
  }

  // A crash tears the last record alone. Whole records behind a bad one tell of other damage.
  absl::Status MendEnd(const ManifestScan& scan, ManifestLog& log) {
    if (scan.rest.ok()) return absl::OkStatus();
    const std::string_view rest = std::string_view(scan.bytes).substr(scan.whole_bytes);
    if (HoldsWholeRecord(rest)) return scan.rest;
    if (scan.whole_bytes == 0 && !HasNoCaptures()) return scan.rest;
    if (!rest.empty()) EYEBOX_RETURN_IF_ERROR(KeepAside("manifest.log", rest));
    report_.manifest_bytes_cut = rest.size();
    return log.CutRest();
  }

  absl::Status MendCapture(const BegunCapture& begun, ManifestLog& log) {
    const int number = begun.entry.number;
    const Path published = CapturePath(recording_, number);
    const Path partial = PartialPath(recording_, number);
    const bool was_renamed = Exists(published);
    if (!was_renamed && !Exists(partial)) return absl::OkStatus();
    report_.capture = {.number = number,
                       .frames_announced = begun.entry.row_count,
                       .was_renamed = was_renamed,
                       .file = was_renamed ? published : partial};
    EYEBOX_ASSIGN_OR_RETURN(UnixFile file, UnixFile::OpenToWrite(report_.capture->file));
    const absl::Status intact = CheckStructure(file, begun);
    if (absl::IsDataLoss(intact)) return SetAside(std::string(intact.message()));
    EYEBOX_RETURN_IF_ERROR(intact);
    EYEBOX_ASSIGN_OR_RETURN(const RowCensus rows, TakeCensus(file, begun.entry));
    report_.capture->frames_kept = rows.whole;
    report_.capture->damaged_rows = rows.damaged;
    if (rows.whole > 0) return Publish(begun.entry, rows, file, log);
    const bool held_any = was_renamed || !rows.damaged.empty();
    return held_any ? SetAside("none of its frames is whole") : Remove();
  }

  absl::Status Publish(ManifestEntry entry, const RowCensus& rows, UnixFile& file,
                       ManifestLog& log) {
    if (!rows.unreadable.empty()) {
      EYEBOX_ASSIGN_OR_RETURN(const std::string records, ReadRecords(file, entry));
      EYEBOX_RETURN_IF_ERROR(KeepAside(
          CapturePath(recording_, entry.number).stem().string() + ".frame_records", records));
      EYEBOX_RETURN_IF_ERROR(EmptyRows(rows.unreadable, entry, file));
    }
    std::string damaged;
    EYEBOX_RETURN_IF_ERROR(MendSideRows(file, entry.side, damaged));
    if (!damaged.empty()) {
      EYEBOX_RETURN_IF_ERROR(
          KeepAside(CapturePath(recording_, entry.number).stem().string() + ".side_rows", damaged));
    }
    report_.capture->samples_kept = static_cast<int64_t>(entry.side.sample_count);
    entry.frame_count = rows.whole;
    EYEBOX_ASSIGN_OR_RETURN(entry.digest_xxh3, DigestOf(file, entry));
    EYEBOX_RETURN_IF_ERROR(file.Sync());
    const Path published = CapturePath(recording_, entry.number);
    EYEBOX_RETURN_IF_ERROR(report_.capture->was_renamed ? SyncFolder(published.parent_path())
                                                        : RenameDurably(file.path(), published));
    report_.capture->file = published;
    return log.Append(entry);
  }

  // A file that was being prepared holds no frame: the manifest names a capture before its first.
  absl::Status MendUnbegun(int next) {
    const Path partial = PartialPath(recording_, next);
    if (report_.capture || !Exists(partial)) return absl::OkStatus();
    report_.capture = {.number = next, .file = partial};
    return SetAside("it was being prepared: manifest.log does not say that it took a frame");
  }

  absl::Status Remove() {
    std::error_code error;
    std::filesystem::remove(std::exchange(report_.capture->file, {}), error);
    if (error) return SystemFailed(recording_.string(), error.value(), "check the disk");
    return SyncFolder(CapturesFolder(recording_));
  }

  absl::Status SetAside(std::string remark) {
    report_.capture->remark = std::move(remark);
    if (report_.capture->was_renamed) return absl::OkStatus();  // verification names it
    EYEBOX_RETURN_IF_ERROR(CreateFolders(recording_ / "aside"));
    Path to = recording_ / "aside" / report_.capture->file.filename();
    for (int i = 2; Exists(to); ++i) {
      to.replace_filename(report_.capture->file.filename().string() + "." + std::to_string(i));
    }
    EYEBOX_RETURN_IF_ERROR(RenameDurably(report_.capture->file, to));
    report_.capture->file = to;
    report_.kept_aside.push_back(to);
    return SyncFolder(CapturesFolder(recording_));
  }

  // Named by its checksum: to keep the same bytes twice changes nothing.
  absl::Status KeepAside(const std::string& name, std::string_view bytes) {
    const Path file = recording_ / "aside" / (name + "." + std::to_string(Checksum(bytes)));
    report_.kept_aside.push_back(file);
    return WriteFileAtomically(file, bytes);
  }

  const Path recording_;
  RecoverReport report_;
};

}  // namespace

absl::StatusOr<RecoverReport> RecoverRecording(const std::filesystem::path& recording) {
  Recovery recovery(recording);
  EYEBOX_RETURN_IF_ERROR(recovery.Run());
  return std::move(recovery).report();
}

}  // namespace eyebox::capture
