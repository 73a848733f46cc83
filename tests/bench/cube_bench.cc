// Design of a table with its certificate, expanded to the cube that is written; the encoding of
// the text beside it. Counter `in_time`: the time allowed (50 ms for 32^3, 250 ms for 64^3) over
// the time taken.
#include <benchmark/benchmark.h>

#include <ctime>

#include "fit/cube/table_file.h"

namespace eyebox::fit {
namespace {

constexpr Activation kDisplay = {0.775, 420.75, 0.0335, 2.4};

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void Design(benchmark::State& state, TableTarget target, double allowed_s) {
  const int size = static_cast<int>(state.range(0));
  double max_relative = 0;
  const double start_s = CpuSeconds();
  for (auto _ : state) {
    const auto table = DesignTable(kDisplay, target, size);
    if (!table.ok()) {
      state.SkipWithError(std::string(table.status().message()).c_str());
      break;
    }
    const Cube3d cube = ToCube(*table, "bench");
    benchmark::DoNotOptimize(cube.entries.data());
    max_relative = table->certificate.max_relative;
  }
  const double each_s = (CpuSeconds() - start_s) / static_cast<double>(state.iterations());
  state.counters["in_time"] = allowed_s / each_s;
  state.counters["max_relative"] = max_relative;
}

void DesignHdrp(benchmark::State& state) {
  Design(state, TableTarget::kHdrp, state.range(0) <= 32 ? 0.05 : 0.25);
}
BENCHMARK(DesignHdrp)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

void DesignPps(benchmark::State& state) { Design(state, TableTarget::kPps, 0.05); }
BENCHMARK(DesignPps)->Arg(32)->Unit(benchmark::kMillisecond);

void EncodeHdrp(benchmark::State& state) {
  const auto table = DesignTable(kDisplay, TableTarget::kHdrp, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(EncodeTable(*table)->data());
}
BENCHMARK(EncodeHdrp)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::fit
