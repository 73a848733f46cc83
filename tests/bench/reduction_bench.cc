// Reduction of 12-bit frames of 0.3 to 12 megapixels with variance and mask: frames into stacks,
// stacks into luminance, against memcpy of the same number of bytes in the same run, on the wall
// clock and all processors. Counters:
//   raw_GB_per_s  bytes of the frames over the time from the first frame to the luminance
//   memcpys       that time over one thread's memcpy that reads and writes as many bytes as the
//                 reduction must: frames, darks and flat once, luminance, variance and mask once
//   memcpys_2     the same against memcpy on all processors
// Each the least disturbed of its runs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <vector>

#include "capture/base/parallel.h"
#include "optics/reduce/reduce_level.h"

namespace eyebox::optics {
namespace {

constexpr SensorRange kTwelveBits{12};
constexpr double kRateDnS = 50000;

// Cheap noise: the time of drawing is not measured, but waited for.
Image<uint16_t> DrawFrame(ImageSize size, double exposure_s, double rate_dn_s, uint32_t seed) {
  Image<uint16_t> frame(size);
  uint32_t state = seed;
  for (int y = 0; y < size.height_px; ++y) {
    const auto row = frame.row(y);
    for (int x = 0; x < size.width_px; ++x) {
      state = state * 1664525U + 1013904223U;
      const double light = rate_dn_s * exposure_s * x / size.width_px;
      row[x] = static_cast<uint16_t>(std::min(60 + light + (state >> 29), 4095.0));
    }
  }
  return frame;
}

std::vector<Stack> StackAll(ImageSize size, const std::vector<double>& exposures_s,
                            double rate_dn_s, int frames) {
  std::vector<Stack> stacks;
  for (const double exposure_s : exposures_s) {
    FrameStacker stacker({exposure_s, 0}, kTwelveBits);
    for (int k = 0; k < frames; ++k) {
      const Image<uint16_t> frame =
          DrawFrame(size, exposure_s, rate_dn_s, static_cast<uint32_t>(k + 1));
      if (!stacker.Add({frame.pixels(), frame.size()}).ok()) std::abort();
    }
    stacks.push_back(*stacker.Finish());
  }
  return stacks;
}

Calibration Calibrate(ImageSize size, const std::vector<double>& exposures_s) {
  Calibration calibration;
  calibration.noise = {.gain_dn_per_e = 0.25, .read_variance_dn2 = 5, .bias_dn = 64};
  calibration.defects.defective = Image<uint8_t>(size);
  for (const Stack& dark : StackAll(size, exposures_s, 0, 2)) {
    calibration.darks.push_back(*MeasureDark(dark, calibration.noise));
  }
  calibration.flat = *MeasureFlat(StackAll(size, {exposures_s[0]}, kRateDnS, 2), calibration,
                                  KnownLuminance{100, 0.01});
  return calibration;
}

template <typename Work>
double Seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void Copy(const std::vector<char>& from, std::vector<char>& to) {
  std::memcpy(to.data(), from.data(), from.size());
  benchmark::ClobberMemory();
}

void CopyOnAllProcessors(const std::vector<char>& from, std::vector<char>& to) {
  constexpr int kPieces = 16;
  ForEachInParallel(kPieces, [&](int piece) {
    const size_t first = from.size() / kPieces * piece;
    const size_t end = piece + 1 == kPieces ? from.size() : first + from.size() / kPieces;
    std::memcpy(to.data() + first, from.data() + first, end - first);
  });
  benchmark::ClobberMemory();
}

void Reduction(benchmark::State& state) {
  const std::vector<double> exposures_s = {0.01, 0.03};
  const ImageSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const auto frames_per_exposure = static_cast<int>(state.range(2));
  const Calibration calibration = Calibrate(size, exposures_s);
  std::vector<std::vector<Image<uint16_t>>> frames(exposures_s.size());
  for (size_t e = 0; e < exposures_s.size(); ++e) {
    for (int k = 0; k < frames_per_exposure; ++k) {
      frames[e].push_back(DrawFrame(size, exposures_s[e], kRateDnS, static_cast<uint32_t>(k + 7)));
    }
  }
  constexpr size_t kMeasuredBytes = 2 * sizeof(float) + 1;  // value, variance, mask
  const double pixels = static_cast<double>(size.PixelCount());
  const double exposures = static_cast<double>(exposures_s.size());
  const double raw_bytes = pixels * exposures * frames_per_exposure * sizeof(uint16_t);
  const double read_and_written =
      raw_bytes + pixels * kMeasuredBytes * (exposures + 1) + pixels * kMeasuredBytes;
  // A copy of n bytes reads n and writes n.
  const std::vector<char> from(static_cast<size_t>(read_and_written / 2), 1);
  std::vector<char> to(from.size(), 2);
  std::vector<double> copy_s, parallel_copy_s, stack_s, reduce_s, total_s;
  for (auto _ : state) {
    copy_s.push_back(Seconds([&] { Copy(from, to); }));
    parallel_copy_s.push_back(Seconds([&] { CopyOnAllProcessors(from, to); }));
    std::vector<Stack> stacks;
    stack_s.push_back(Seconds([&] {
      for (size_t e = 0; e < exposures_s.size(); ++e) {
        FrameStacker stacker({exposures_s[e], 0}, kTwelveBits);
        for (const auto& frame : frames[e]) {
          if (!stacker.Add({frame.pixels(), frame.size()}).ok()) std::abort();
        }
        stacks.push_back(*stacker.Finish());
      }
    }));
    reduce_s.push_back(Seconds([&] {
      auto level = ReduceLevel(stacks, calibration, {.colour_period_px = 1});
      if (!level.ok()) std::abort();
      benchmark::DoNotOptimize(level);
    }));
    total_s.push_back(stack_s.back() + reduce_s.back());
  }
  const auto least = [](const std::vector<double>& s) { return *std::ranges::min_element(s); };
  state.counters["raw_GB"] = raw_bytes / 1e9;
  state.counters["raw_GB_per_s"] = raw_bytes / 1e9 / least(total_s);
  state.counters["memcpys"] = least(total_s) / least(copy_s);
  state.counters["memcpys_2"] = least(total_s) / least(parallel_copy_s);
  state.counters["memcpy_GB_per_s"] = read_and_written / 1e9 / least(copy_s);
  state.counters["stack_ms"] = least(stack_s) * 1e3;
  state.counters["reduce_ms"] = least(reduce_s) * 1e3;
}

// Frames at each of two exposures.
BENCHMARK(Reduction)
    ->ArgNames({"width_px", "height_px", "frames"})
    ->Args({4096, 3000, 8})
    ->Args({4096, 3000, 2})
    ->Args({4096, 3000, 16})
    ->Args({640, 480, 8})
    ->Args({1280, 960, 8})
    ->Args({2048, 1536, 8})
    ->Iterations(7)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::optics
