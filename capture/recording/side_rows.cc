#include "capture/recording/side_rows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <optional>
#include <type_traits>

namespace eyebox::capture {
namespace {

static_assert(std::endian::native == std::endian::little);
static_assert(std::has_unique_object_representations_v<SampleRow>);
static_assert(std::has_unique_object_representations_v<SampleGroup>);
static_assert(std::has_unique_object_representations_v<TripleRow>);

template <typename Row>
uint64_t ChecksumOf(const Row& row) {
  return Checksum(&row, offsetof(Row, record_xxh3));
}

template <typename Row>
bool AllZeros(const Row& row) {
  const std::array<std::byte, sizeof(Row)> zeros = {};
  return std::memcmp(&row, zeros.data(), zeros.size()) == 0;
}

bool Within(uint64_t offset, uint64_t rows, uint64_t row_bytes, uint64_t file_bytes) {
  return rows <= file_bytes / row_bytes && offset <= file_bytes - rows * row_bytes;
}

}  // namespace

bool SideRows::CanBe(uint64_t file_bytes) const {
  return sample_count <= sample_capacity && (sample_capacity == 0) == (group_capacity == 0) &&
         Within(samples_offset_bytes, sample_capacity, sizeof(SampleRow), file_bytes) &&
         Within(groups_offset_bytes, group_capacity, sizeof(SampleGroup), file_bytes) &&
         Within(triples_offset_bytes, triple_capacity, sizeof(TripleRow), file_bytes);
}

std::vector<SampleRow> RowsOf(const SampleBlock& block, uint64_t count) {
  std::vector<SampleRow> rows(std::min<uint64_t>(count, block.samples.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {.monotonic_ns = block.samples[i].monotonic_ns,
               .time_uncertainty_ns = block.time_uncertainty_ns,
               .sequence = block.sequence + i,
               .counts = block.samples[i].counts};
    if (block.device_time_ns.empty()) continue;
    rows[i].device_time_ns = block.device_time_ns[i];
    rows[i].flags = kSampleDeviceTime;
  }
  if (rows.empty()) return rows;
  rows.front().lost_before = block.lost_before;
  rows.front().flags |= kBeginsBlock;
  return rows;
}

std::vector<SampleBlock> BlocksOf(std::span<const SampleRow> rows) {
  std::vector<SampleBlock> blocks;
  for (const SampleRow& row : rows) {
    if (blocks.empty() || (row.flags & kBeginsBlock) != 0) {
      blocks.push_back({.sequence = row.sequence,
                        .lost_before = row.lost_before,
                        .time_uncertainty_ns = row.time_uncertainty_ns});
    }
    SampleBlock& block = blocks.back();
    block.samples.push_back({.monotonic_ns = row.monotonic_ns, .counts = row.counts});
    if ((row.flags & kSampleDeviceTime) != 0) block.device_time_ns.push_back(row.device_time_ns);
  }
  return blocks;
}

SampleGroup MakeGroup(uint64_t first, std::span<const SampleRow> rows, uint64_t samples_lost,
                      uint64_t index) {
  SampleGroup group = {.first = first,
                       .count = rows.size(),
                       .samples_lost = samples_lost,
                       .samples_xxh3 = Checksum(rows.data(), rows.size_bytes()),
                       .group_index = static_cast<uint32_t>(index)};
  group.record_xxh3 = ChecksumOf(group);
  return group;
}

bool IsWhole(const SampleGroup& group, uint64_t index, uint64_t sample_capacity) {
  return group.written == 1 && group.group_index == index &&
         group.record_xxh3 == ChecksumOf(group) && group.count <= sample_capacity &&
         group.first <= sample_capacity - group.count;
}

bool Vouches(const SampleGroup& group, std::span<const SampleRow> rows) {
  return group.count == rows.size() &&
         group.samples_xxh3 == Checksum(rows.data(), rows.size_bytes());
}

bool IsEmpty(const SampleGroup& group) { return AllZeros(group); }

TripleRow MakeTriple(const ClockTriple& triple, uint64_t index) {
  TripleRow row = {.monotonic_ns = triple.monotonic_ns,
                   .real_ns = triple.real_ns,
                   .device_ns = triple.device_ns.value_or(0),
                   .window_ns = triple.window_ns,
                   .triple_index = static_cast<uint32_t>(index),
                   .has_device = triple.device_ns.has_value() ? uint16_t{1} : uint16_t{0}};
  row.record_xxh3 = ChecksumOf(row);
  return row;
}

bool IsWhole(const TripleRow& row, uint64_t index) {
  return row.written == 1 && row.triple_index == index && row.record_xxh3 == ChecksumOf(row);
}

bool IsEmpty(const TripleRow& row) { return AllZeros(row); }

ClockTriple TripleOf(const TripleRow& row) {
  ClockTriple triple = {.monotonic_ns = row.monotonic_ns,
                        .real_ns = row.real_ns,
                        .device_ns = std::nullopt,
                        .window_ns = row.window_ns};
  if (row.has_device != 0) triple.device_ns = row.device_ns;
  return triple;
}

}  // namespace eyebox::capture
