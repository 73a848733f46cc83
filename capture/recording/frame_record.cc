#include "capture/recording/frame_record.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include "capture/base/status.h"
#include "capture/recording/checksum.h"

namespace eyebox::capture {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(std::has_unique_object_representations_v<BufferStatus>);

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

void Put(const std::optional<double>& value, FrameField field, FrameRecord& record, double& to) {
  to = value.value_or(kUnknown);
  if (value) record.valid = static_cast<uint16_t>(record.valid | field);
}

void Put(const std::optional<int64_t>& value, FrameField field, FrameRecord& record, int64_t& to) {
  to = value.value_or(0);
  if (value) record.valid = static_cast<uint16_t>(record.valid | field);
}

template <typename T>
std::optional<T> Get(const FrameRecord& record, FrameField field, T value) {
  return record.valid & field ? std::optional<T>(value) : std::nullopt;
}

uint64_t ChecksumOf(const FrameRecord& record) {
  return Checksum(&record, offsetof(FrameRecord, record_xxh3));
}

uint64_t ChecksumOf(std::span<const uint16_t> pixels_dn) {
  return Checksum(pixels_dn.data(), pixels_dn.size_bytes());
}

constexpr const char* kRemedy = "restore the file from a copy or capture it again";

}  // namespace

FrameRecord MakeFrameRecord(const Frame& frame, uint32_t frame_index, int level_id) {
  const FrameMetadata& metadata = frame.metadata;
  FrameRecord record;
  record.camera_frame_id = metadata.camera_frame_id;
  record.monotonic_time_ns = metadata.monotonic_time_ns;
  record.exposure_asked_s = metadata.exposure_asked_s;
  record.gain_asked_db = metadata.gain_asked_db;
  Put(metadata.device_time_ns, kDeviceTime, record, record.device_time_ns);
  Put(metadata.trigger_time_ns, kTriggerTime, record, record.trigger_time_ns);
  Put(metadata.exposure_reported_s, kExposureReported, record, record.exposure_reported_s);
  Put(metadata.gain_reported_db, kGainReported, record, record.gain_reported_db);
  Put(metadata.black_level_dn, kBlackLevel, record, record.black_level_dn);
  Put(metadata.temperature_degC, kTemperature, record, record.temperature_degC);
  Put(metadata.photodiode_counts, kPhotodiode, record, record.photodiode_counts);
  record.frame_xxh3 = ChecksumOf(frame.view.pixels_dn);
  record.frame_index = frame_index;
  record.missing_packets = metadata.missing_packets;
  record.level_id = level_id;
  record.state = FrameState::kWritten;
  record.buffer_status = metadata.status;
  record.record_xxh3 = ChecksumOf(record);
  return record;
}

FrameMetadata MetadataOf(const FrameRecord& record) {
  FrameMetadata metadata;
  metadata.status = record.buffer_status;
  metadata.camera_frame_id = record.camera_frame_id;
  metadata.missing_packets = record.missing_packets;
  metadata.device_time_ns = Get(record, kDeviceTime, record.device_time_ns);
  metadata.monotonic_time_ns = record.monotonic_time_ns;
  metadata.trigger_time_ns = Get(record, kTriggerTime, record.trigger_time_ns);
  metadata.exposure_asked_s = record.exposure_asked_s;
  metadata.exposure_reported_s = Get(record, kExposureReported, record.exposure_reported_s);
  metadata.gain_asked_db = record.gain_asked_db;
  metadata.gain_reported_db = Get(record, kGainReported, record.gain_reported_db);
  metadata.black_level_dn = Get(record, kBlackLevel, record.black_level_dn);
  metadata.temperature_degC = Get(record, kTemperature, record.temperature_degC);
  metadata.photodiode_counts = Get(record, kPhotodiode, record.photodiode_counts);
  return metadata;
}

bool IsEmpty(const FrameRecord& record) {
  const auto bytes = std::as_bytes(std::span(&record, 1));
  return std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
}

absl::Status CheckRecord(const FrameRecord& record, uint32_t frame_index,
                         std::span<const uint16_t> pixels_dn, const std::string& where) {
  if (record.record_xxh3 != ChecksumOf(record) || record.frame_index != frame_index) {
    return Corrupt(where, "its record does not match its checksum", kRemedy);
  }
  if (record.state != FrameState::kWritten || record.buffer_status != BufferStatus::kComplete) {
    return Corrupt(where, "was never written completely", kRemedy);
  }
  if (record.frame_xxh3 != ChecksumOf(pixels_dn)) {
    return Corrupt(where, "its pixels do not match their checksum", kRemedy);
  }
  return absl::OkStatus();
}

}  // namespace eyebox::capture
