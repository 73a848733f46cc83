#include "capture/photodiode/replay/replay_photodiode.h"

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "capture/base/csv.h"
#include "capture/base/status.h"
#include "capture/photodiode/photodiode_state.h"
#include "capture/recording/reader.h"

namespace eyebox::capture {
namespace {

constexpr std::string_view kScheme = "replay:";
constexpr size_t kBlockSamples = 1024;
constexpr size_t kFileLimitBytes = size_t{256} << 20;

class BlockBuilder {
 public:
  absl::Status Add(int64_t monotonic_ns, int64_t counts, int64_t sequence,
                   const std::string& line) {
    if (counts < std::numeric_limits<int32_t>::min() ||
        counts > std::numeric_limits<int32_t>::max()) {
      return BadInput(line, "holds counts of more than 32 bits", "write raw counts");
    }
    if (monotonic_ns <= last_ns_) {
      return BadInput(line, "is not later than the line before", "sort by monotonic_ns");
    }
    if (sequence < next_sequence_) {
      return BadInput(line, "repeats or steps back in the sequence", "write each sample once");
    }
    if (blocks_.empty() || sequence != next_sequence_ ||
        blocks_.back().samples.size() == kBlockSamples) {
      SampleBlock block;
      block.sequence = static_cast<uint64_t>(sequence);
      block.lost_before = static_cast<uint64_t>(sequence - next_sequence_);
      blocks_.push_back(std::move(block));
    }
    blocks_.back().samples.push_back(
        {.monotonic_ns = monotonic_ns, .counts = static_cast<int32_t>(counts)});
    last_ns_ = monotonic_ns;
    next_sequence_ = sequence + 1;
    return absl::OkStatus();
  }

  int64_t next_sequence() const { return next_sequence_; }
  std::vector<SampleBlock> Take() { return std::move(blocks_); }

 private:
  std::vector<SampleBlock> blocks_;
  int64_t last_ns_ = std::numeric_limits<int64_t>::min();
  int64_t next_sequence_ = 0;
};

class ReplayPhotodiode final : public Photodiode {
 public:
  ReplayPhotodiode(PhotodiodeInfo info, std::vector<SampleBlock> blocks)
      : info_(std::move(info)), state_(info_.uri), blocks_(std::move(blocks)) {}

  const PhotodiodeInfo& Info() const override { return info_; }

  absl::StatusOr<PhotodiodeSettings> Configure(const PhotodiodeSettings& settings) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckConfigure(info_, settings));
    state_.Configured(settings);
    return settings;
  }

  absl::Status Start() override {
    next_ = 0;
    return state_.Start(0);
  }

  absl::StatusOr<SampleBlock> Read(std::chrono::milliseconds) override {
    EYEBOX_RETURN_IF_ERROR(state_.CheckRead());
    if (next_ < blocks_.size()) return blocks_[next_++];
    return absl::OutOfRangeError(
        Complaint(info_.uri, "holds no more samples", "start it again from the first one"));
  }

  absl::Status Stop() override {
    state_.Stop();
    return absl::OkStatus();
  }

 private:
  const PhotodiodeInfo info_;
  PhotodiodeState state_;
  const std::vector<SampleBlock> blocks_;
  size_t next_ = 0;
};

absl::StatusOr<std::vector<SampleBlock>> BlocksOf(const CsvTable& table) {
  EYEBOX_ASSIGN_OR_RETURN(const size_t time_column, table.Column("monotonic_ns"));
  EYEBOX_ASSIGN_OR_RETURN(const size_t counts_column, table.Column("counts"));
  const std::optional<size_t> sequence_column = table.FindColumn("sequence");
  BlockBuilder builder;
  for (size_t row = 0; row < table.RowCount(); ++row) {
    EYEBOX_ASSIGN_OR_RETURN(const long monotonic_ns, table.WholeNumber(row, time_column));
    EYEBOX_ASSIGN_OR_RETURN(const long counts, table.WholeNumber(row, counts_column));
    long sequence = builder.next_sequence();
    if (sequence_column) {
      EYEBOX_ASSIGN_OR_RETURN(sequence, table.WholeNumber(row, *sequence_column));
    }
    const std::string line = table.File().string() + ":" + std::to_string(table.LineOf(row));
    EYEBOX_RETURN_IF_ERROR(builder.Add(monotonic_ns, counts, sequence, line));
  }
  return builder.Take();
}

// The captures one after another: each counted from 0, and goes on counting here.
absl::StatusOr<std::vector<SampleBlock>> RecordedBlocks(const std::filesystem::path& recording) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, RecordingReader::Open(recording));
  std::vector<SampleBlock> blocks;
  uint64_t next = 0;
  uint64_t lost = 0;  // behind the last block, for want of room in its file
  for (const CaptureEntry& capture : reader->Captures()) {
    if (!capture.suspect.empty()) continue;
    const uint64_t begin = next + lost;
    EYEBOX_RETURN_IF_ERROR(reader->VisitSamples(capture, [&](const SampleBlock& block) {
      blocks.push_back(block);
      blocks.back().sequence += begin;
      blocks.back().lost_before = blocks.back().sequence - next;
      next = blocks.back().sequence + block.samples.size();
      return absl::OkStatus();
    }));
    lost = (next > begin ? 0 : lost) + static_cast<uint64_t>(capture.samples_lost);
  }
  if (!blocks.empty()) return blocks;
  return Missing(recording.string(), "is a recording without samples of a photodiode",
                 "name one that was captured with a photodiode");
}

// What cannot be looked at is reported by the reading.
absl::StatusOr<std::vector<SampleBlock>> ReadBlocks(std::filesystem::path file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    const bool has_table = std::filesystem::exists(file / "photodiode.csv", ignored);
    if (!has_table && std::filesystem::exists(file / "manifest.log", ignored)) {
      return RecordedBlocks(file);
    }
    file /= "photodiode.csv";
  }
  EYEBOX_ASSIGN_OR_RETURN(const CsvTable table, ReadCsv(file, kFileLimitBytes));
  return BlocksOf(table);
}

}  // namespace

absl::StatusOr<std::unique_ptr<Photodiode>> OpenReplayPhotodiode(const PhotodiodeConfig& config,
                                                                 const Clock*) {
  const std::filesystem::path file = config.uri.substr(kScheme.size());
  if (file.empty()) {
    return BadInput(config.uri, "names no folder", "give a URI like replay:recordings/a");
  }
  EYEBOX_ASSIGN_OR_RETURN(std::vector<SampleBlock> blocks, ReadBlocks(file));
  PhotodiodeInfo info = {.uri = config.uri,
                         .model = "recorded samples",
                         .significant_bits = 32,
                         .minimum_counts = std::numeric_limits<int32_t>::min(),
                         .maximum_counts = std::numeric_limits<int32_t>::max(),
                         .sample_rate_min_hz = std::numeric_limits<double>::min(),
                         .sample_rate_max_hz = std::numeric_limits<double>::max(),
                         .can_be_pulse_started = true};
  return std::make_unique<ReplayPhotodiode>(std::move(info), std::move(blocks));
}

}  // namespace eyebox::capture
