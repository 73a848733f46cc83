// One row of /frame_records: all that is known of a frame but its pixels, and both checksums.
#ifndef EYEBOX_CAPTURE_RECORDING_FRAME_RECORD_H_
#define EYEBOX_CAPTURE_RECORDING_FRAME_RECORD_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "capture/base/frame.h"

namespace eyebox::capture {

// Bits of FrameRecord::valid. A field whose bit is not set holds 0 or NaN and means nothing.
enum FrameField : uint16_t {
  kDeviceTime = 1 << 0,
  kTriggerTime = 1 << 1,
  kExposureReported = 1 << 2,
  kGainReported = 1 << 3,
  kBlackLevel = 1 << 4,
  kTemperature = 1 << 5,
  kPhotodiode = 1 << 6,
};

enum class FrameState : uint8_t {
  kEmpty = 0,
  kWritten = 1,
};

// As it lies on disk, little-endian, without gaps: every byte is under record_xxh3.
struct FrameRecord {
  uint64_t camera_frame_id = 0;
  int64_t device_time_ns = 0;
  int64_t monotonic_time_ns = 0;
  int64_t trigger_time_ns = 0;
  double exposure_asked_s = 0;
  double exposure_reported_s = 0;
  double gain_asked_db = 0;
  double gain_reported_db = 0;
  double black_level_dn = 0;
  double temperature_degC = 0;  // NOLINT(readability-identifier-naming): the unit's own case
  double photodiode_counts = 0;
  uint64_t frame_xxh3 = 0;   // of the pixels, row by row, little-endian
  uint32_t frame_index = 0;  // row of /frames
  uint32_t missing_packets = 0;
  int32_t level_id = 0;
  uint16_t valid = 0;
  FrameState state = FrameState::kEmpty;
  BufferStatus buffer_status = BufferStatus::kComplete;
  uint64_t record_xxh3 = 0;  // of all bytes before it
};
static_assert(sizeof(FrameRecord) == 120);

FrameRecord MakeFrameRecord(const Frame& frame, uint32_t frame_index, int level_id);

// What `record` says of its frame, without pixels.
FrameMetadata MetadataOf(const FrameRecord& record);

// All zeros: the row never took a frame.
bool IsEmpty(const FrameRecord& record);

// Whether `record` is intact, is of the row `frame_index` and of these pixels.
// Errors: DataLoss, naming `where` (file and frame).
absl::Status CheckRecord(const FrameRecord& record, uint32_t frame_index,
                         std::span<const uint16_t> pixels_dn, const std::string& where);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_FRAME_RECORD_H_
