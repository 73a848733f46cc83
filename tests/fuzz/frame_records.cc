// Frame records with the pixels behind them. An odd first byte has both checksums mended first.
#include <cmath>
#include <cstring>
#include <vector>

#include "capture/recording/checksum.h"
#include "capture/recording/frame_record.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::capture;
  FrameRecord record;
  if (size < 1 + sizeof(record)) return 0;
  std::memcpy(&record, data + 1, sizeof(record));
  std::vector<uint16_t> pixels((size - 1 - sizeof(record)) / sizeof(uint16_t));
  if (!pixels.empty()) {
    std::memcpy(pixels.data(), data + 1 + sizeof(record), pixels.size() * sizeof(uint16_t));
  }
  if (data[0] % 2 == 1) {
    record.frame_xxh3 = Checksum(pixels.data(), pixels.size() * sizeof(uint16_t));
    record.record_xxh3 = Checksum(&record, offsetof(FrameRecord, record_xxh3));
  }
  IsEmpty(record);
  if (!CheckRecord(record, 0, pixels, "fuzz").ok()) return 0;
  FUZZ_CHECK(record.frame_index == 0 && record.state == FrameState::kWritten);
  const auto metadata = MetadataOf(record);
  FUZZ_CHECK(metadata.device_time_ns.has_value() == ((record.valid & kDeviceTime) != 0));
  return 0;
}
