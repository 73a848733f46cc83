// What a photodiode gives: raw counts of an ADC, each with its time.
#ifndef EYEBOX_CAPTURE_BASE_SAMPLE_BLOCK_H_
#define EYEBOX_CAPTURE_BASE_SAMPLE_BLOCK_H_

#include <cstdint>
#include <vector>

namespace eyebox::capture {

struct PhotodiodeSample {
  int64_t monotonic_ns = 0;  // CLOCK_MONOTONIC at which the conversion began
  int32_t counts = 0;
  friend bool operator==(const PhotodiodeSample&, const PhotodiodeSample&) = default;
};

// Consecutive conversions: whatever was lost, was lost before the first of them.
struct SampleBlock {
  uint64_t sequence = 0;     // of the first sample; conversions are counted from 0 at Start()
  uint64_t lost_before = 0;  // conversions between the previous block and this one
  std::vector<PhotodiodeSample> samples = {};  // never empty, times ascending
  int64_t time_uncertainty_ns = 0;  // bound of the error of monotonic_ns common to the block
  // The converter's own clock, one for each sample; empty where it has none.
  std::vector<int64_t> device_time_ns = {};
  friend bool operator==(const SampleBlock&, const SampleBlock&) = default;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_BASE_SAMPLE_BLOCK_H_
