// The frames and samples of the fault tests: row r of capture c has id 1000 c + r, and its pixels
// follow from it.
#ifndef EYEBOX_TESTS_FAULT_FAULT_FRAME_H_
#define EYEBOX_TESTS_FAULT_FAULT_FRAME_H_

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "capture/base/frame.h"
#include "capture/base/sample_block.h"

namespace eyebox::capture {

constexpr uint64_t kIdsPerCapture = 1000;

// check_frames.py knows the same formula.
inline uint16_t FaultPixel(uint64_t id, size_t i) {
  return static_cast<uint16_t>(id * 2654435761U + i * 40503U);
}

inline Frame FaultFrame(uint64_t id, ImageSize size) {
  auto counts_dn = std::make_shared<std::vector<uint16_t>>(size.PixelCount());
  for (size_t i = 0; i < counts_dn->size(); ++i) (*counts_dn)[i] = FaultPixel(id, i);
  Frame frame;
  frame.metadata.camera_frame_id = id;
  frame.metadata.monotonic_time_ns = static_cast<int64_t>(id);
  frame.metadata.exposure_asked_s = 0.01;
  frame.view = {.pixels_dn = *counts_dn, .size = size};
  frame.owner = std::move(counts_dn);
  return frame;
}

// The samples that were taken beside row r of a capture: their counts are their sequence, negative.
constexpr size_t kSamplesPerFrame = 3;

inline SampleBlock FaultSamples(int row) {
  SampleBlock block = {.sequence = kSamplesPerFrame * static_cast<uint64_t>(row)};
  for (size_t i = 0; i < kSamplesPerFrame; ++i) {
    const auto number = static_cast<int32_t>(block.sequence + i);
    block.samples.push_back({.monotonic_ns = 100 + number, .counts = -number});
  }
  return block;
}

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_FAULT_FAULT_FRAME_H_
