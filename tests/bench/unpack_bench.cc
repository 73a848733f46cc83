// Throughput of each unpacker beside memcpy of the same counts; `memcpy_ratio` is time / time.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "capture/base/pixel_format.h"
#include "capture/base/unpack.h"

namespace eyebox {
namespace {

constexpr ImageSize kFrame = {.width_px = 4096, .height_px = 3000};  // 12 megapixels

using Clock = std::chrono::steady_clock;

// Alternates both, so that they meet the same caches and the same clock frequency.
void UnpackBesideMemcpy(benchmark::State& state, PixelFormat format) {
  const size_t pixels = kFrame.PixelCount();
  const std::vector<std::byte> packed(PackedBytes(format.packing, pixels), std::byte{0x5A});
  std::vector<uint16_t> counts_dn(pixels);
  std::vector<uint16_t> copy_dn(pixels);
  Clock::duration unpacking{};
  Clock::duration copying{};
  for (auto _ : state) {
    const auto start = Clock::now();
    if (!Unpack(format.packing, packed, kFrame, 0, counts_dn).ok()) state.SkipWithError("refused");
    benchmark::DoNotOptimize(counts_dn.data());
    benchmark::ClobberMemory();
    const auto middle = Clock::now();
    std::memcpy(copy_dn.data(), counts_dn.data(), pixels * sizeof(uint16_t));
    benchmark::DoNotOptimize(copy_dn.data());
    benchmark::ClobberMemory();
    unpacking += middle - start;
    copying += Clock::now() - middle;
    state.SetIterationTime(std::chrono::duration<double>(middle - start).count());
  }
  state.SetBytesProcessed(state.iterations() * pixels * sizeof(uint16_t));
  state.counters["memcpy_ratio"] =
      static_cast<double>(unpacking.count()) / static_cast<double>(copying.count());
}

const bool kRegistered = [] {
  for (const char* name :
       {"Mono8", "Mono16", "Mono10p", "Mono12p", "Mono10Packed", "Mono12Packed"}) {
    benchmark::RegisterBenchmark(("Unpack/" + std::string(name)).c_str(), UnpackBesideMemcpy,
                                 *FindPixelFormat(name))
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace eyebox
