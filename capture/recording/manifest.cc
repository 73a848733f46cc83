#include "capture/recording/manifest.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/checksum.h"
#include "capture/recording/convert.h"
#include "capture/recording/layout.h"

namespace eyebox::capture {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr size_t kLargestManifest = size_t{16} << 20;
constexpr uint32_t kHeaderType = 1;
constexpr uint32_t kCaptureType = 2;

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
  return Corrupt(where, what, "restore manifest.log from a copy of the recording");
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
  return proto;
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
  if (entry.frame_size.width_px > 0 && entry.frame_size.height_px > 0 && entry.frame_count > 0 &&
      entry.frames_offset_bytes + entry.FramesBytes() <= entry.file_bytes &&
      entry.records_offset_bytes < entry.file_bytes) {
    return entry;
  }
  return Damaged(where, "states sizes that cannot be");
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

absl::Status AddCapture(const std::string& payload, const std::string& where, Manifest& manifest) {
  v1::ManifestCapture proto;
  if (!proto.ParseFromString(payload)) return Damaged(where, "is no capture record");
  EYEBOX_ASSIGN_OR_RETURN(ManifestEntry entry, FromProto(proto, where));
  if (entry.number != static_cast<int>(manifest.entries.size()) + 1) {
    return Damaged(where, "names capture " + std::to_string(entry.number) + " out of turn");
  }
  manifest.entries.push_back(std::move(entry));
  return absl::OkStatus();
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

absl::StatusOr<ManifestLog> ManifestLog::Create(const std::filesystem::path& file,
                                                std::string_view header_text) {
  EYEBOX_ASSIGN_OR_RETURN(UnixFile created, UnixFile::Create(file));
  ManifestLog log(std::move(created));
  v1::ManifestHeader proto;
  proto.set_format_version(kFormatVersion);
  proto.set_header_bytes(header_text.size());
  proto.set_header_xxh3(Checksum(header_text));
  EYEBOX_RETURN_IF_ERROR(log.AppendRecord(kHeaderType, proto.SerializeAsString()));
  EYEBOX_RETURN_IF_ERROR(SyncFolder(file.parent_path()));
  return log;
}

absl::Status ManifestLog::Append(const ManifestEntry& entry) {
  return AppendRecord(kCaptureType, ToProto(entry).SerializeAsString());
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

absl::StatusOr<Manifest> ReadManifest(const std::filesystem::path& file) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, ReadWholeFile(file, kLargestManifest));
  if (bytes.empty()) return Damaged(file.string(), "is empty");
  Manifest manifest;
  for (size_t at = 0; at < bytes.size();) {
    const std::string where = file.string() + ", byte " + std::to_string(at);
    const bool first = at == 0;
    EYEBOX_ASSIGN_OR_RETURN(const auto record, NextRecord(bytes, at, where));
    const auto& [type, payload] = record;
    if (type != (first ? kHeaderType : kCaptureType)) {
      return Damaged(where, "holds a record of unknown type " + std::to_string(type));
    }
    EYEBOX_RETURN_IF_ERROR(first ? AddHeader(payload, where, manifest)
                                 : AddCapture(payload, where, manifest));
  }
  return manifest;
}

}  // namespace eyebox::capture
