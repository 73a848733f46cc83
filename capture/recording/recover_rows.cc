#include "capture/recording/recover_rows.h"

#include <array>
#include <cstdint>

#include "capture/base/status.h"
#include "capture/recording/frame_record.h"

namespace eyebox::capture {

absl::Status CheckStructure(const UnixFile& file, const BegunCapture& begun) {
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t size, file.Size());
  EYEBOX_ASSIGN_OR_RETURN(const uint64_t structure, StructureOf(file, begun.entry));
  if (size == begun.entry.file_bytes && structure == begun.structure_xxh3) {
    return absl::OkStatus();
  }
  return Corrupt(file.path().string(), "is damaged outside of its frames, or was prepared anew",
                 "capture it again; a copy or another program may still read it");
}

absl::StatusOr<RowCensus> TakeCensus(const UnixFile& file, const ManifestEntry& entry) {
  RowCensus census;
  std::vector<int> empty;
  std::vector<uint16_t> pixels_dn(entry.frame_size.PixelCount());
  for (int row = 0; row < entry.row_count; ++row) {
    const auto index = static_cast<uint32_t>(row);
    FrameRecord record;
    EYEBOX_RETURN_IF_ERROR(file.ReadAt(entry.RecordOffset(index), &record, sizeof(record)));
    if (IsEmpty(record)) {
      empty.push_back(row);
      continue;
    }
    EYEBOX_RETURN_IF_ERROR(
        file.ReadAt(entry.FrameOffset(index), pixels_dn.data(), entry.FrameBytes()));
    if (CheckRecord(record, index, pixels_dn, "").ok()) {
      ++census.whole;
      // Frames are written in order: the empty rows before this one have lost theirs.
      census.damaged.insert(census.damaged.end(), empty.begin(), empty.end());
      empty.clear();
    } else {
      census.damaged.push_back(row);
      census.unreadable.push_back(row);
    }
  }
  return census;
}

absl::StatusOr<std::string> ReadRecords(const UnixFile& file, const ManifestEntry& entry) {
  std::string bytes(static_cast<size_t>(entry.row_count) * sizeof(FrameRecord), '\0');
  EYEBOX_RETURN_IF_ERROR(file.ReadAt(entry.RecordOffset(0), bytes.data(), bytes.size()));
  return bytes;
}

absl::Status EmptyRows(const std::vector<int>& rows, const ManifestEntry& entry, UnixFile& file) {
  const std::array<std::byte, sizeof(FrameRecord)> zeros = {};
  for (const int row : rows) {
    EYEBOX_RETURN_IF_ERROR(
        file.WriteAt(entry.RecordOffset(static_cast<uint64_t>(row)), zeros.data(), zeros.size()));
  }
  return absl::OkStatus();
}

}  // namespace eyebox::capture
