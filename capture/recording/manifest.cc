#include "capture/recording/manifest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/checksum.h"
#include "capture/recording/convert.h"
#include "capture/recording/frame_record.h"
#include "capture/recording/layout.h"

namespace eyebox::capture {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kLargestManifest = size_t{16} << 20;
constexpr uint32_t kHeaderType = 1;
constexpr uint32_t kCaptureType = 2;
constexpr uint32_t kBegunType = 3;
constexpr uint32_t kSuspectType = 4;

// Stands before every payload.
struct Prefix {
  uint32_t length = 0;  // of the payload
  uint32_t type = 0;
  uint64_t xxh3 = 0;  // of length, type and payload
};
static_assert(sizeof(Prefix) == 16);

uint64_t ChecksumOf(const Prefix& prefix, std::string_view payload) {
  std::string bytes(reinterpret_cast<const char*>(&prefix), offsetof(Prefix, xxh3));
  return Checksum(bytes.append(payload));
}

absl::Status Damaged(const std::string& where, std::string_view what) {
  return Corrupt(where, what,
                 "restore manifest.log from a copy; after a crash, eyebox recover mends its end");
}

v1::SideRows ToProto(const SideRows& side) {
  v1::SideRows proto;
  proto.set_sample_capacity(static_cast<int64_t>(side.sample_capacity));
  proto.set_sample_count(static_cast<int64_t>(side.sample_count));
  proto.set_samples_lost(static_cast<int64_t>(side.samples_lost));
  proto.set_group_capacity(static_cast<int64_t>(side.group_capacity));
  proto.set_triple_capacity(static_cast<int64_t>(side.triple_capacity));
  proto.set_samples_offset_bytes(side.samples_offset_bytes);
  proto.set_groups_offset_bytes(side.groups_offset_bytes);
  proto.set_triples_offset_bytes(side.triples_offset_bytes);
  return proto;
}

// A negative count becomes one that cannot be.
SideRows FromProto(const v1::SideRows& proto) {
  return {.sample_capacity = static_cast<uint64_t>(proto.sample_capacity()),
          .sample_count = static_cast<uint64_t>(proto.sample_count()),
          .samples_lost = static_cast<uint64_t>(proto.samples_lost()),
          .group_capacity = static_cast<uint64_t>(proto.group_capacity()),
          .triple_capacity = static_cast<uint64_t>(proto.triple_capacity()),
          .samples_offset_bytes = proto.samples_offset_bytes(),
          .groups_offset_bytes = proto.groups_offset_bytes(),
          .triples_offset_bytes = proto.triples_offset_bytes()};
}

v1::ManifestCapture ToProto(const ManifestEntry& entry) {
  v1::ManifestCapture proto;
  proto.set_number(entry.number);
  *proto.mutable_spec() = capture::ToProto(entry.spec);
  proto.set_frame_width_px(entry.frame_size.width_px);
  proto.set_frame_height_px(entry.frame_size.height_px);
  proto.set_frame_count(entry.frame_count);
  proto.set_packed(entry.packed);
  proto.set_file_bytes(entry.file_bytes);
  proto.set_frames_offset_bytes(entry.frames_offset_bytes);
  proto.set_records_offset_bytes(entry.records_offset_bytes);
  proto.set_digest_xxh3(entry.digest_xxh3);
  if (entry.row_count != entry.frame_count) proto.set_row_count(entry.row_count);
  if (!entry.side.Empty()) *proto.mutable_side() = ToProto(entry.side);
  return proto;
}

// Divides instead of multiplying: a product of what a hostile manifest states may wrap.
bool FitsBehind(uint64_t offset_bytes, uint64_t count, uint64_t item_bytes, uint64_t file_bytes) {
  return offset_bytes <= file_bytes && count <= (file_bytes - offset_bytes) / item_bytes;
}

bool SizesCanBe(const ManifestEntry& entry) {
  if (entry.frame_size.width_px <= 0 || entry.frame_size.height_px <= 0 || entry.frame_count <= 0 ||
      entry.row_count < entry.frame_count) {
    return false;
  }
  const auto rows = static_cast<uint64_t>(entry.row_count);
  return FitsBehind(entry.frames_offset_bytes, entry.packed ? 0 : rows, entry.FrameBytes(),
                    entry.file_bytes) &&
         FitsBehind(entry.records_offset_bytes, rows, sizeof(FrameRecord), entry.file_bytes) &&
         entry.side.CanBe(entry.file_bytes);
}

absl::StatusOr<ManifestEntry> FromProto(const v1::ManifestCapture& proto,
                                        const std::string& where) {
  ManifestEntry entry;
  EYEBOX_ASSIGN_OR_RETURN(entry.spec, capture::FromProto(proto.spec(), where));
  entry.number = proto.number();
  entry.frame_size = {proto.frame_width_px(), proto.frame_height_px()};
  entry.frame_count = proto.frame_count();
  entry.packed = proto.packed();
  entry.file_bytes = proto.file_bytes();
  entry.frames_offset_bytes = proto.frames_offset_bytes();
  entry.records_offset_bytes = proto.records_offset_bytes();
  entry.digest_xxh3 = proto.digest_xxh3();
  entry.side = FromProto(proto.side());
  entry.row_count = proto.row_count() == 0 ? entry.frame_count : proto.row_count();
  if (!SizesCanBe(entry)) return Damaged(where, "states sizes that cannot be");
  return entry;
}

absl::Status AddHeader(const std::string& payload, const std::string& where, Manifest& manifest) {
  v1::ManifestHeader proto;
  if (!proto.ParseFromString(payload)) return Damaged(where, "is no header record");
  if (proto.format_version() != kFormatVersion) {
    return BadInput(where, "is of format version " + std::to_string(proto.format_version()),
                    "read it with the version of Eyebox that wrote it; this one knows version " +
                        std::to_string(kFormatVersion));
  }
  manifest.header_bytes = proto.header_bytes();
  manifest.header_xxh3 = proto.header_xxh3();
  return absl::OkStatus();
}

absl::Status CheckTurn(const ManifestEntry& entry, const std::string& where,
                       const Manifest& manifest) {
  if (entry.number == static_cast<int>(manifest.entries.size()) + 1) return absl::OkStatus();
  return Damaged(where, "names capture " + std::to_string(entry.number) + " out of turn");
}

absl::Status AddCapture(const std::string& payload, const std::string& where, Manifest& manifest) {
  v1::ManifestCapture proto;
  if (!proto.ParseFromString(payload)) return Damaged(where, "is no capture record");
  EYEBOX_ASSIGN_OR_RETURN(ManifestEntry entry, FromProto(proto, where));
  EYEBOX_RETURN_IF_ERROR(CheckTurn(entry, where, manifest));
  manifest.entries.push_back(std::move(entry));
  manifest.begun.reset();
  return absl::OkStatus();
}

absl::Status AddBegun(const std::string& payload, const std::string& where, Manifest& manifest) {
  v1::ManifestBegun proto;
  if (!proto.ParseFromString(payload)) return Damaged(where, "is no record of a begun capture");
  EYEBOX_ASSIGN_OR_RETURN(ManifestEntry entry, FromProto(proto.capture(), where));
  EYEBOX_RETURN_IF_ERROR(CheckTurn(entry, where, manifest));
  manifest.begun = {std::move(entry), proto.structure_xxh3()};
  return absl::OkStatus();
}

absl::Status AddSuspects(const std::string& payload, const std::string& where, Manifest& manifest) {
  v1::ManifestSuspect proto;
  if (!proto.ParseFromString(payload)) return Damaged(where, "is no record of suspect captures");
  const int published = static_cast<int>(manifest.entries.size());
  if (proto.first() < 1 || proto.last() < proto.first() || proto.last() > published ||
      proto.reason().empty()) {
    return Damaged(where, "suspects captures that are not there, or says not why");
  }
  for (int number = proto.first(); number <= proto.last(); ++number) {
    manifest.entries[static_cast<size_t>(number) - 1].suspect = proto.reason();
  }
  return absl::OkStatus();
}

absl::Status AddRecord(uint32_t type, const std::string& payload, bool first,
                       const std::string& where, Manifest& manifest) {
  if (first && type == kHeaderType) return AddHeader(payload, where, manifest);
  if (!first && type == kCaptureType) return AddCapture(payload, where, manifest);
  if (!first && type == kBegunType) return AddBegun(payload, where, manifest);
  if (!first && type == kSuspectType) return AddSuspects(payload, where, manifest);
  return Damaged(where, "holds a record of unknown type " + std::to_string(type));
}

// The payload of the record at `at`, which moves behind it.
absl::StatusOr<std::pair<uint32_t, std::string>> NextRecord(const std::string& bytes, size_t& at,
                                                            const std::string& where) {
  Prefix prefix;
  if (bytes.size() - at < sizeof(prefix)) return Damaged(where, "ends within a record");
  std::memcpy(&prefix, bytes.data() + at, sizeof(prefix));
  at += sizeof(prefix);
  if (bytes.size() - at < prefix.length) return Damaged(where, "ends within a record");
  std::string payload = bytes.substr(at, prefix.length);
  at += prefix.length;
  if (prefix.xxh3 != ChecksumOf(prefix, payload)) {
    return Damaged(where, "the record does not match its checksum");
  }
  return std::pair(prefix.type, std::move(payload));
}

}  // namespace

uint64_t ManifestEntry::RecordOffset(uint64_t row) const {
  return records_offset_bytes + row * sizeof(FrameRecord);
}

absl::StatusOr<uint64_t> DigestOf(const UnixFile& file, const ManifestEntry& entry) {
  const ByteRange frames = {entry.frames_offset_bytes, entry.FramesBytes()};
  return ChecksumOutside(file, {&frames, 1});
}

absl::StatusOr<uint64_t> StructureOf(const UnixFile& file, const ManifestEntry& entry) {
  std::vector<ByteRange> written = {
      {entry.frames_offset_bytes, entry.FramesBytes()},
      {entry.records_offset_bytes, static_cast<uint64_t>(entry.row_count) * sizeof(FrameRecord)}};
  for (const ByteRange& rows : {entry.side.Samples(), entry.side.Groups(), entry.side.Triples()}) {
    if (rows.size > 0) written.push_back(rows);
  }
  std::ranges::sort(written, {}, &ByteRange::offset);
  return ChecksumOutside(file, written);
}

absl::StatusOr<ManifestLog> ManifestLog::Create(const std::filesystem::path& file,
                                                std::string_view header_text) {
  EYEBOX_ASSIGN_OR_RETURN(UnixFile created, UnixFile::Create(file));
  ManifestLog log(std::move(created));
  EYEBOX_RETURN_IF_ERROR(log.Lock());
  v1::ManifestHeader proto;
  proto.set_format_version(kFormatVersion);
  proto.set_header_bytes(header_text.size());
  proto.set_header_xxh3(Checksum(header_text));
  EYEBOX_RETURN_IF_ERROR(log.AppendRecord(kHeaderType, proto.SerializeAsString()));
  EYEBOX_RETURN_IF_ERROR(SyncFolder(file.parent_path()));
  return log;
}

absl::StatusOr<ManifestLog> ManifestLog::Open(const std::filesystem::path& file,
                                              ManifestScan& scan) {
  EYEBOX_ASSIGN_OR_RETURN(UnixFile opened, UnixFile::OpenToWrite(file));
  ManifestLog log(std::move(opened));
  EYEBOX_RETURN_IF_ERROR(log.Lock());
  EYEBOX_ASSIGN_OR_RETURN(scan, ScanManifest(file));
  log.end_ = scan.whole_bytes;
  return log;
}

absl::Status ManifestLog::Lock() {
  EYEBOX_ASSIGN_OR_RETURN(const bool locked, file_.TryLock(UnixFile::Lock::kExclusive));
  if (locked) return absl::OkStatus();
  return Rejected(file_.path().string(), "is locked: something records to it",
                  "wait until it is done");
}

absl::Status ManifestLog::Append(const ManifestEntry& entry) {
  return AppendRecord(kCaptureType, ToProto(entry).SerializeAsString());
}

absl::Status ManifestLog::Append(const BegunCapture& begun) {
  v1::ManifestBegun proto;
  *proto.mutable_capture() = ToProto(begun.entry);
  proto.set_structure_xxh3(begun.structure_xxh3);
  return AppendRecord(kBegunType, proto.SerializeAsString());
}

absl::Status ManifestLog::Append(const SuspectCaptures& suspects) {
  v1::ManifestSuspect proto;
  proto.set_first(suspects.first);
  proto.set_last(suspects.last);
  proto.set_reason(suspects.reason);
  return AppendRecord(kSuspectType, proto.SerializeAsString());
}

absl::Status ManifestLog::CutRest() {
  EYEBOX_RETURN_IF_ERROR(file_.Truncate(end_));
  return file_.Sync();
}

absl::Status ManifestLog::AppendRecord(uint32_t type, const std::string& payload) {
  Prefix prefix = {.length = static_cast<uint32_t>(payload.size()), .type = type, .xxh3 = 0};
  prefix.xxh3 = ChecksumOf(prefix, payload);
  std::string record(reinterpret_cast<const char*>(&prefix), sizeof(prefix));
  record.append(payload);
  EYEBOX_RETURN_IF_ERROR(file_.WriteAt(end_, record.data(), record.size()));
  end_ += record.size();
  return file_.Sync();
}

absl::StatusOr<ManifestScan> ScanManifest(const std::filesystem::path& file) {
  ManifestScan scan;
  EYEBOX_ASSIGN_OR_RETURN(scan.bytes, ReadWholeFile(file, kLargestManifest));
  if (scan.bytes.empty()) scan.rest = Damaged(file.string(), "is empty");
  for (size_t at = 0; scan.rest.ok() && at < scan.bytes.size();) {
    const std::string where = file.string() + ", byte " + std::to_string(at);
    const bool first = at == 0;
    const auto record = NextRecord(scan.bytes, at, where);
    scan.rest = record.ok() ? AddRecord(record->first, record->second, first, where, scan.manifest)
                            : record.status();
    if (absl::IsInvalidArgument(scan.rest)) return scan.rest;  // whole, yet beyond this version
    if (scan.rest.ok()) scan.whole_bytes = at;
  }
  return scan;
}

bool HoldsWholeRecord(std::string_view bytes) {
  Prefix prefix;
  for (; bytes.size() >= sizeof(prefix); bytes.remove_prefix(1)) {
    std::memcpy(&prefix, bytes.data(), sizeof(prefix));
    const std::string_view payload = bytes.substr(sizeof(prefix));
    if (prefix.length > 0 && prefix.length <= payload.size() &&
        prefix.xxh3 == ChecksumOf(prefix, payload.substr(0, prefix.length))) {
      return true;
    }
  }
  return false;
}

absl::StatusOr<Manifest> ReadManifest(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(ManifestScan scan, ScanManifest(file));
  if (scan.rest.ok()) return std::move(scan.manifest);
  EYEBOX_ASSIGN_OR_RETURN(const bool writing, IsBeingWritten(file));
  if (writing && scan.whole_bytes > 0) return std::move(scan.manifest);
  // The writer may have finished between the two looks.
  EYEBOX_ASSIGN_OR_RETURN(scan, ScanManifest(file));
  if (!scan.rest.ok()) return scan.rest;
  return std::move(scan.manifest);
}

absl::StatusOr<bool> IsBeingWritten(const std::filesystem::path& manifest) {
  EYEBOX_ASSIGN_OR_RETURN(UnixFile file, UnixFile::OpenToRead(manifest));
  EYEBOX_ASSIGN_OR_RETURN(const bool locked, file.TryLock(UnixFile::Lock::kShared));
  return !locked;
}

}  // namespace eyebox::capture
