// The common-exponent fit of a whole field against one memcpy of its stack, in the same run.
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

constexpr size_t kLocations = 1048576;
constexpr size_t kLevels = 17;

struct Field {
  std::vector<double> drives;
  std::vector<float> luminance;
  FieldStack Stack() const { return {drives, luminance, {}}; }
};

Field Simulate() {
  Field field;
  RandomStream random({17});
  std::vector<double> gains(kLocations);
  for (double& gain : gains) gain = 100 + 50 * random.Uniform();
  for (size_t level = 0; level < kLevels; ++level) {
    field.drives.push_back(static_cast<double>(level) / (kLevels - 1));
    const double power = std::pow(field.drives.back(), 2.2);
    for (const double gain : gains) {
      const double noise = 1 + 0.01 * (random.Uniform() - 0.5);
      field.luminance.push_back(static_cast<float>((gain * power + 0.5) * noise));
    }
  }
  return field;
}

const Field& TheField() {
  static const Field field = Simulate();
  return field;
}

template <typename Work>
double Seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void CommonExponentAgainstMemcpy(benchmark::State& state) {
  const Field& field = TheField();
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
}
BENCHMARK(CommonExponentAgainstMemcpy)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(50);

}  // namespace
}  // namespace eyebox::fit
