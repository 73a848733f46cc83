// The common-exponent fit of a whole field against one memcpy of its stack, in the same run, for
// fields of 0.3 to 12 megapixels and stacks of 5 to 65 levels.
// Counter `memcpys`: time of the fit, which takes all processors, over that of the copy on one of
// them, each the least disturbed of its runs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <vector>

#include "capture/base/random.h"
#include "fit/field/common_exponent.h"

namespace eyebox::fit {
namespace {

struct Field {
  std::vector<double> drives;
  std::vector<float> luminance;
  FieldStack Stack() const { return {drives, luminance, {}}; }
};

Field Simulate(size_t locations, size_t levels) {
  Field field;
  RandomStream random({17});
  std::vector<double> gains(locations);
  for (double& gain : gains) gain = 100 + 50 * random.Uniform();
  field.luminance.reserve(locations * levels);
  for (size_t level = 0; level < levels; ++level) {
    field.drives.push_back(static_cast<double>(level) / static_cast<double>(levels - 1));
    const double power = std::pow(field.drives.back(), 2.2);
    for (const double gain : gains) {
      const double noise = 1 + 0.01 * (random.Uniform() - 0.5);
      field.luminance.push_back(static_cast<float>((gain * power + 0.5) * noise));
    }
  }
  return field;
}

template <typename Work>
double Seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void CommonExponentAgainstMemcpy(benchmark::State& state) {
  const Field field =
      Simulate(static_cast<size_t>(state.range(0)), static_cast<size_t>(state.range(1)));
  std::vector<float> copy(field.luminance.size());
  std::vector<double> copy_s, fit_s;
  for (auto _ : state) {
    copy_s.push_back(Seconds([&] {
      std::memcpy(copy.data(), field.luminance.data(), copy.size() * sizeof(float));
      benchmark::DoNotOptimize(copy.data());
    }));
    fit_s.push_back(Seconds([&] {
      auto fit = FitCommonExponent(field.Stack());
      benchmark::DoNotOptimize(fit);
      if (!fit.ok()) state.SkipWithError("the fit failed");
    }));
  }
  const double least_copy_s = *std::min_element(copy_s.begin(), copy_s.end());
  const double least_fit_s = *std::min_element(fit_s.begin(), fit_s.end());
  state.counters["memcpy_ms"] = 1e3 * least_copy_s;
  state.counters["fit_ms"] = 1e3 * least_fit_s;
  state.counters["memcpys"] = least_fit_s / least_copy_s;
  state.counters["ns_per_location"] = 1e9 * least_fit_s / static_cast<double>(state.range(0));
}
BENCHMARK(CommonExponentAgainstMemcpy)
    ->ArgNames({"locations", "levels"})
    ->Args({1048576, 17})
    ->Args({307200, 17})
    ->Args({3145728, 17})
    ->Args({12288000, 17})
    ->Args({1048576, 5})
    ->Args({1048576, 33})
    ->Args({1048576, 65})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(25);

}  // namespace
}  // namespace eyebox::fit
