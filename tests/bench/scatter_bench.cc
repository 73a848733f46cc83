// Scatter correction of float32 images of 0.3 to 12 megapixels with variance, mask and floor,
// against the two cv::dft calls that it needs, in the same run: of twice the size, or the next that
// the transform is good at. Counter `dfts`: time of the correction over that of the pair, each the
// least disturbed of its runs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "capture/base/random.h"
#include "opencv2/core.hpp"
#include "optics/scatter/correct_scatter.h"

namespace eyebox::optics {
namespace {

constexpr double kPitchDeg = 0.05;
const ScatterKernel kLens{.core_radius_deg = 0.04,
                          .tail_share = 0.1,
                          .tail_radius_deg = 1.5,
                          .tail_exponent = 2.6,
                          .pedestal_share = 0.005};

LuminanceImage Checkerboard(ImageSize size, bool masked) {
  RandomStream random({4});
  LuminanceImage reading;
  reading.image = MakeMeasuredImage(size, "cd/m2");
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      const double light = ((x / 128 + y / 128) % 2 == 0) ? 100 : 12;
      reading.image.value.at(x, y) = static_cast<float>(light + random.Uniform() - 0.5);
      reading.image.variance.at(x, y) = 1.0F / 12;
      if (masked && random.Below(1000) == 0) reading.image.mask.at(x, y) = kDefective;
    }
  }
  BlankMaskedPixels(reading.image);
  return reading;
}

// Of the processor, so that other programs on the machine do not count; both run on one thread.
template <typename Work>
double Seconds(const Work& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

void TransformPair(int rows, cv::Mat& padded) {
  cv::dft(padded, padded, 0, rows);
  cv::dft(padded, padded, cv::DFT_INVERSE | cv::DFT_SCALE, rows);
}

ImageSize SizeOf(const benchmark::State& state) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(0))};
}

void CorrectionAgainstTwoTransforms(benchmark::State& state, bool masked) {
  cv::setNumThreads(1);
  const ImageSize size = SizeOf(state);
  const LuminanceImage reading = Checkerboard(size, masked);
  auto corrector = ScatterCorrector::Create(kLens, size, kPitchDeg);
  if (!corrector.ok()) {
    state.SkipWithError(std::string(corrector.status().message()).c_str());
    return;
  }
  const int padded_px = cv::getOptimalDFTSize(2 * size.width_px);
  cv::Mat padded(padded_px, padded_px, CV_32F, cv::Scalar(1));
  std::vector<double> pair_s, correction_s;
  for (auto _ : state) {
    pair_s.push_back(Seconds([&] { TransformPair(size.height_px, padded); }));
    correction_s.push_back(Seconds([&] {
      auto correction = corrector->Correct(reading);
      benchmark::DoNotOptimize(correction);
    }));
  }
  const double pair = *std::ranges::min_element(pair_s);
  const double correction = *std::ranges::min_element(correction_s);
  state.counters["pair_ms"] = pair * 1e3;
  state.counters["correction_ms"] = correction * 1e3;
  state.counters["dfts"] = correction / pair;
}

// Once for a kernel and image size.
void Preparation(benchmark::State& state) {
  cv::setNumThreads(1);
  for (auto _ : state) {
    auto corrector = ScatterCorrector::Create(kLens, SizeOf(state), kPitchDeg);
    benchmark::DoNotOptimize(corrector);
  }
}

BENCHMARK_CAPTURE(CorrectionAgainstTwoTransforms, no_mask, false)
    ->ArgName("side_px")
    ->Arg(2048)
    ->Arg(548)
    ->Arg(1024)
    ->Arg(3464)
    ->Iterations(7)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CorrectionAgainstTwoTransforms, one_in_a_thousand_masked, true)
    ->ArgName("side_px")
    ->Arg(2048)
    ->Iterations(7)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Preparation)->ArgName("side_px")->Arg(2048)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::optics
