// What a capture file holds beside its frames: samples of the photodiode and clock triples. All of
// it lies in rows of fixed size at places that the manifest names, as frames do.
#ifndef EYEBOX_CAPTURE_RECORDING_SIDE_ROWS_H_
#define EYEBOX_CAPTURE_RECORDING_SIDE_ROWS_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "capture/base/clock_triple.h"
#include "capture/base/sample_block.h"
#include "capture/recording/checksum.h"

namespace eyebox::capture {

// Bits of SampleRow::flags.
enum SampleFlag : uint32_t {
  kBeginsBlock = 1 << 0,
  kSampleDeviceTime = 1 << 1,  // without it, device_time_ns is 0 and means nothing
};

// One row of /photodiode/samples, little-endian, without gaps.
struct SampleRow {
  int64_t monotonic_ns = 0;
  int64_t device_time_ns = 0;
  int64_t time_uncertainty_ns = 0;  // of its block
  uint64_t sequence = 0;
  uint64_t lost_before = 0;  // of the block that it begins; 0 in the others
  int32_t counts = 0;
  uint32_t flags = 0;
};
static_assert(sizeof(SampleRow) == 48);

// One row of /photodiode/groups: vouches for the samples that one acknowledgement covered.
struct SampleGroup {
  uint64_t first = 0;         // row of /photodiode/samples
  uint64_t count = 0;         // 0: tells of lost samples alone
  uint64_t samples_lost = 0;  // since the capture began, for want of room
  uint64_t samples_xxh3 = 0;  // of the rows
  uint32_t group_index = 0;   // row of /photodiode/groups
  uint32_t written = 1;
  uint64_t record_xxh3 = 0;  // of all bytes before it
};
static_assert(sizeof(SampleGroup) == 48);

// One row of /clock_triples.
struct TripleRow {
  int64_t monotonic_ns = 0;
  int64_t real_ns = 0;
  int64_t device_ns = 0;
  int64_t window_ns = 0;
  uint32_t triple_index = 0;
  uint16_t has_device = 0;
  uint16_t written = 1;
  uint64_t record_xxh3 = 0;  // of all bytes before it
};
static_assert(sizeof(TripleRow) == 48);

// Where they lie and how many there are.
struct SideRows {
  uint64_t sample_capacity = 0;
  uint64_t sample_count = 0;
  uint64_t samples_lost = 0;
  uint64_t group_capacity = 0;
  uint64_t triple_capacity = 0;
  uint64_t samples_offset_bytes = 0;
  uint64_t groups_offset_bytes = 0;
  uint64_t triples_offset_bytes = 0;
  friend bool operator==(const SideRows&, const SideRows&) = default;

  bool Empty() const { return sample_capacity == 0 && triple_capacity == 0; }
  ByteRange Samples() const { return {samples_offset_bytes, sample_capacity * sizeof(SampleRow)}; }
  ByteRange Groups() const { return {groups_offset_bytes, group_capacity * sizeof(SampleGroup)}; }
  ByteRange Triples() const { return {triples_offset_bytes, triple_capacity * sizeof(TripleRow)}; }
  uint64_t Bytes() const { return Samples().size + Groups().size + Triples().size; }
  // Whether all of it lies within a file of `file_bytes`, and no more is counted than fits.
  bool CanBe(uint64_t file_bytes) const;
};

// The first `count` samples of the block; all of it where it is shorter.
std::vector<SampleRow> RowsOf(const SampleBlock& block, uint64_t count);
// The blocks that `rows` were made of.
std::vector<SampleBlock> BlocksOf(std::span<const SampleRow> rows);

SampleGroup MakeGroup(uint64_t first, std::span<const SampleRow> rows, uint64_t samples_lost,
                      uint64_t index);
// Whether the record is intact, of row `index`, and of samples that there is room for.
bool IsWhole(const SampleGroup& group, uint64_t index, uint64_t sample_capacity);
bool Vouches(const SampleGroup& group, std::span<const SampleRow> rows);
bool IsEmpty(const SampleGroup& group);

TripleRow MakeTriple(const ClockTriple& triple, uint64_t index);
bool IsWhole(const TripleRow& row, uint64_t index);
bool IsEmpty(const TripleRow& row);
ClockTriple TripleOf(const TripleRow& row);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RECORDING_SIDE_ROWS_H_
