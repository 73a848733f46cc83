#include "capture/recording/side_file.h"

#include <algorithm>
#include <array>

#include "capture/base/status.h"

namespace eyebox::capture {
namespace {

constexpr const char* kRemedy = "restore the file from a copy or capture it again";

template <typename Row>
absl::StatusOr<Row> ReadRow(const UnixFile& file, uint64_t offset_bytes, uint64_t index) {
  Row row;
  EYEBOX_RETURN_IF_ERROR(file.ReadAt(offset_bytes + index * sizeof(row), &row, sizeof(row)));
  return row;
}

absl::StatusOr<std::vector<SampleRow>> ReadSamples(const UnixFile& file, const SideRows& rows,
                                                   const SampleGroup& group) {
  std::vector<SampleRow> samples(group.count);
  EYEBOX_RETURN_IF_ERROR(file.ReadAt(rows.samples_offset_bytes + group.first * sizeof(SampleRow),
                                     samples.data(), samples.size() * sizeof(SampleRow)));
  return samples;
}

// Makes the row zeros, and keeps what it held.
template <typename Row>
absl::Status EmptyRow(const Row& row, uint64_t offset_bytes, uint64_t index, UnixFile& file,
                      std::string& damaged) {
  damaged.append(reinterpret_cast<const char*>(&row), sizeof(row));
  const std::array<std::byte, sizeof(Row)> zeros = {};
  return file.WriteAt(offset_bytes + index * sizeof(row), zeros.data(), zeros.size());
}

absl::StatusOr<bool> GroupIsWhole(const UnixFile& file, const SideRows& rows,
                                  const SampleGroup& group, uint64_t index) {
  if (!IsWhole(group, index, rows.sample_capacity)) return false;
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<SampleRow> samples, ReadSamples(file, rows, group));
  return Vouches(group, samples);
}

absl::Status CopyRange(const UnixFile& from, ByteRange source, UnixFile& to, uint64_t offset) {
  std::vector<char> piece(size_t{1} << 20);
  for (uint64_t done = 0; done < source.size;) {
    const size_t size = std::min<uint64_t>(piece.size(), source.size - done);
    EYEBOX_RETURN_IF_ERROR(from.ReadAt(source.offset + done, piece.data(), size));
    EYEBOX_RETURN_IF_ERROR(to.WriteAt(offset + done, piece.data(), size));
    done += size;
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status SideWriter::Check(const SampleBlock& block, const UnixFile& file) {
  const size_t device_times = block.device_time_ns.size();
  if (!block.samples.empty() && (device_times == 0 || device_times == block.samples.size())) {
    return absl::OkStatus();
  }
  return BadInput(file.path().string() + ", sample " + std::to_string(block.sequence),
                  "begins a block without samples, or with another number of device times",
                  "give one or more samples, and a device time for each or none");
}

absl::Status SideWriter::Append(const SampleBlock& block, UnixFile& file) {
  const uint64_t first = rows_.sample_count + pending_.size();
  // Rows that no group could vouch for would be nobody's.
  const uint64_t room = groups_ < rows_.group_capacity ? rows_.sample_capacity - first : 0;
  const std::vector<SampleRow> rows = RowsOf(block, room);
  rows_.samples_lost += block.samples.size() - rows.size();
  if (rows.empty()) return absl::OkStatus();
  pending_.insert(pending_.end(), rows.begin(), rows.end());
  return file.WriteAt(rows_.samples_offset_bytes + first * sizeof(SampleRow), rows.data(),
                      rows.size() * sizeof(SampleRow));
}

absl::Status SideWriter::CloseGroup(UnixFile& file) {
  const bool tells = !pending_.empty() || rows_.samples_lost != lost_told_;
  if (!tells || groups_ == rows_.group_capacity) return absl::OkStatus();
  const SampleGroup group = MakeGroup(rows_.sample_count, pending_, rows_.samples_lost, groups_);
  EYEBOX_RETURN_IF_ERROR(file.WriteAt(rows_.groups_offset_bytes + groups_ * sizeof(SampleGroup),
                                      &group, sizeof(group)));
  rows_.sample_count += pending_.size();
  lost_told_ = rows_.samples_lost;
  pending_.clear();
  ++groups_;
  return absl::OkStatus();
}

absl::Status SideWriter::CheckRoomForTriple(const UnixFile& file) const {
  if (triples_ < rows_.triple_capacity) return absl::OkStatus();
  return absl::ResourceExhaustedError(
      Complaint(file.path().string(),
                "has room for " + std::to_string(rows_.triple_capacity) + " clock triples",
                "announce more of them to BeginCapture"));
}

absl::Status SideWriter::Append(const ClockTriple& triple, UnixFile& file) {
  const TripleRow row = MakeTriple(triple, triples_);
  EYEBOX_RETURN_IF_ERROR(
      file.WriteAt(rows_.triples_offset_bytes + triples_ * sizeof(TripleRow), &row, sizeof(row)));
  ++triples_;
  return absl::OkStatus();
}

absl::Status VisitSideSamples(const UnixFile& file, const SideRows& rows,
                              const BlockVisitor& visit) {
  uint64_t shown = 0;
  for (uint64_t i = 0; i < rows.group_capacity; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const auto group,
                            ReadRow<SampleGroup>(file, rows.groups_offset_bytes, i));
    if (IsEmpty(group)) continue;
    const std::string where = file.path().string() + ", group " + std::to_string(i) + " of samples";
    if (!IsWhole(group, i, rows.sample_capacity)) {
      return Corrupt(where, "its record does not match its checksum", kRemedy);
    }
    EYEBOX_ASSIGN_OR_RETURN(const std::vector<SampleRow> samples, ReadSamples(file, rows, group));
    if (!Vouches(group, samples)) return Corrupt(where, "does not match its checksum", kRemedy);
    for (const SampleBlock& block : BlocksOf(samples)) EYEBOX_RETURN_IF_ERROR(visit(block));
    shown += group.count;
  }
  if (shown == rows.sample_count) return absl::OkStatus();
  return Corrupt(
      file.path().string(),
      "holds " + std::to_string(shown) + " samples instead of " + std::to_string(rows.sample_count),
      kRemedy);
}

absl::StatusOr<std::vector<ClockTriple>> ReadTriples(const UnixFile& file, const SideRows& rows) {
  std::vector<ClockTriple> triples;
  for (uint64_t i = 0; i < rows.triple_capacity; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const auto row, ReadRow<TripleRow>(file, rows.triples_offset_bytes, i));
    if (IsEmpty(row)) continue;
    if (!IsWhole(row, i)) {
      return Corrupt(file.path().string() + ", clock triple " + std::to_string(i),
                     "does not match its checksum", kRemedy);
    }
    triples.push_back(TripleOf(row));
  }
  return triples;
}

absl::Status MendSideRows(UnixFile& file, SideRows& rows, std::string& damaged) {
  rows.sample_count = rows.samples_lost = 0;
  for (uint64_t i = 0; i < rows.group_capacity; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const auto group,
                            ReadRow<SampleGroup>(file, rows.groups_offset_bytes, i));
    if (IsEmpty(group)) continue;
    EYEBOX_ASSIGN_OR_RETURN(const bool whole, GroupIsWhole(file, rows, group, i));
    if (whole) {
      rows.sample_count += group.count;
      rows.samples_lost = group.samples_lost;
    } else {
      EYEBOX_RETURN_IF_ERROR(EmptyRow(group, rows.groups_offset_bytes, i, file, damaged));
    }
  }
  for (uint64_t i = 0; i < rows.triple_capacity; ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const auto row, ReadRow<TripleRow>(file, rows.triples_offset_bytes, i));
    if (IsEmpty(row) || IsWhole(row, i)) continue;
    EYEBOX_RETURN_IF_ERROR(EmptyRow(row, rows.triples_offset_bytes, i, file, damaged));
  }
  return absl::OkStatus();
}

absl::Status CopySideRows(const UnixFile& from, const SideRows& from_rows, UnixFile& to,
                          const SideRows& to_rows) {
  EYEBOX_RETURN_IF_ERROR(CopyRange(from, from_rows.Samples(), to, to_rows.samples_offset_bytes));
  EYEBOX_RETURN_IF_ERROR(CopyRange(from, from_rows.Groups(), to, to_rows.groups_offset_bytes));
  return CopyRange(from, from_rows.Triples(), to, to_rows.triples_offset_bytes);
}

}  // namespace eyebox::capture
