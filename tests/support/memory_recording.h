// A recording in memory, which notes how it was written.
#ifndef EYEBOX_TESTS_SUPPORT_MEMORY_RECORDING_H_
#define EYEBOX_TESTS_SUPPORT_MEMORY_RECORDING_H_

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/recording/writer.h"

namespace eyebox::capture {

struct MemoryCapture {
  CaptureSpec spec;
  std::vector<Frame> frames;
  std::vector<SampleBlock> blocks;
  std::vector<ClockTriple> triples;
  SideRoom room;
  int64_t samples = 0;
  size_t acknowledged = 0;
  bool published = false;
};

class MemoryRecording final : public RecordingWriter {
 public:
  using RecordingWriter::BeginCapture;
  absl::StatusOr<std::unique_ptr<CaptureWriter>> BeginCapture(const CaptureSpec& spec, ImageSize,
                                                              const SideRoom& room) override {
    captures_.push_back(std::make_shared<MemoryCapture>());
    captures_.back()->spec = spec;
    captures_.back()->room = room;
    return std::make_unique<Writer>(captures_.back());
  }

  absl::Status SuspectSince(int first, const std::string&) override {
    suspect_since_.push_back(first);
    return absl::OkStatus();
  }
  int PublishedCount() const override { return static_cast<int>(Published().size()); }

  const std::vector<int>& suspect_since() const { return suspect_since_; }

  // Every capture that was begun, published or not.
  const std::vector<std::shared_ptr<MemoryCapture>>& captures() const { return captures_; }

  std::vector<std::shared_ptr<MemoryCapture>> Published() const {
    std::vector<std::shared_ptr<MemoryCapture>> published;
    for (const auto& capture : captures_) {
      if (capture->published) published.push_back(capture);
    }
    return published;
  }

 private:
  class Writer final : public CaptureWriter {
   public:
    explicit Writer(std::shared_ptr<MemoryCapture> capture) : capture_(std::move(capture)) {}
    absl::Status Append(const Frame& frame) override {
      capture_->frames.push_back(frame);
      return absl::OkStatus();
    }
    absl::Status AppendSamples(const SampleBlock& block) override {
      capture_->blocks.push_back(block);
      capture_->samples += static_cast<int64_t>(block.samples.size());
      return absl::OkStatus();
    }
    absl::Status AppendClockTriple(const ClockTriple& triple) override {
      if (static_cast<int>(capture_->triples.size()) == capture_->room.clock_triples) {
        return absl::ResourceExhaustedError("no room for another clock triple");
      }
      capture_->triples.push_back(triple);
      return absl::OkStatus();
    }
    int64_t samples_lost() const override {
      return std::max<int64_t>(0, capture_->samples - capture_->room.samples);
    }
    absl::Status Acknowledge() override {
      capture_->acknowledged = capture_->frames.size();
      return absl::OkStatus();
    }
    absl::Status Publish() override {
      if (capture_->acknowledged != static_cast<size_t>(capture_->spec.repeats)) {
        return absl::FailedPreconditionError("some frames are not acknowledged");
      }
      capture_->published = true;
      return absl::OkStatus();
    }
    absl::Status PublishEarly() override {
      if (capture_->frames.empty() || capture_->acknowledged != capture_->frames.size()) {
        return absl::FailedPreconditionError("some frames are not acknowledged");
      }
      capture_->published = true;
      return absl::OkStatus();
    }

   private:
    const std::shared_ptr<MemoryCapture> capture_;
  };

  std::vector<std::shared_ptr<MemoryCapture>> captures_;
  std::vector<int> suspect_since_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_SUPPORT_MEMORY_RECORDING_H_
