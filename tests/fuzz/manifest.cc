// manifest.log. An odd first byte has the checksums mended first, so that what they protect is
// reached too.
#include <cstring>

#include "capture/recording/checksum.h"
#include "capture/recording/manifest.h"
#include "tests/fuzz/fuzz_input.h"

namespace eyebox::capture {
namespace {

constexpr size_t kPrefixBytes = 16;  // length, type, xxh3 (proto/README.md)

void MendChecksums(std::string& bytes) {
  for (size_t at = 0; bytes.size() - at >= kPrefixBytes;) {
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + at, sizeof(length));
    if (length > bytes.size() - at - kPrefixBytes) return;
    const uint64_t sum = Checksum(bytes.substr(at, 8) + bytes.substr(at + kPrefixBytes, length));
    std::memcpy(bytes.data() + at + 8, &sum, sizeof(sum));
    at += kPrefixBytes + length;
  }
}

// In 128 bits, in which nothing wraps.
void CheckWithinFile(const ManifestEntry& entry) {
  using Wide = unsigned __int128;
  FUZZ_CHECK(entry.frame_size.width_px > 0 && entry.frame_size.height_px > 0);
  FUZZ_CHECK(entry.frame_count > 0 && entry.row_count >= entry.frame_count);
  const Wide frame = Wide{2} * static_cast<Wide>(entry.frame_size.width_px) *
                     static_cast<Wide>(entry.frame_size.height_px);
  const Wide frames = entry.packed ? 0 : frame * static_cast<Wide>(entry.row_count);
  FUZZ_CHECK(Wide{entry.frames_offset_bytes} + frames <= entry.file_bytes);
  FUZZ_CHECK(Wide{entry.records_offset_bytes} + Wide{120} * static_cast<Wide>(entry.row_count) <=
             entry.file_bytes);
}

}  // namespace
}  // namespace eyebox::capture

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace eyebox::capture;
  if (size == 0) return 0;
  std::string bytes(eyebox::fuzz::AsText(data + 1, size - 1));
  if (data[0] % 2 == 1) MendChecksums(bytes);
  const std::filesystem::path file = eyebox::fuzz::MemoryFile(bytes);
  const auto manifest = ReadManifest(file);
  const auto scan = ScanManifest(file);
  HoldsWholeRecord(bytes);
  if (!scan.ok()) {
    FUZZ_CHECK(!manifest.ok());
    return 0;
  }
  FUZZ_CHECK(scan->whole_bytes <= bytes.size());
  for (const ManifestEntry& entry : scan->manifest.entries) CheckWithinFile(entry);
  if (scan->manifest.begun) CheckWithinFile(scan->manifest.begun->entry);
  return 0;
}
