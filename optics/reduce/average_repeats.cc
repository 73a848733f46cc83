#include "optics/reduce/average_repeats.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

struct Sample {
  float value;
  float variance;
};

float MedianValue(std::vector<Sample> samples) {
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.value < b.value; });
  const size_t middle = samples.size() / 2;
  if (samples.size() % 2 == 1) return samples[middle].value;
  return 0.5F * (samples[middle - 1].value + samples[middle].value);
}

void ClipOutliers(double clip_sigmas, std::vector<Sample>& samples) {
  if (samples.size() < 3) return;
  const float median = MedianValue(samples);
  std::erase_if(samples, [&](const Sample& s) {
    return std::abs(s.value - median) > clip_sigmas * std::sqrt(s.variance);
  });
}

Sample Mean(const std::vector<Sample>& samples) {
  double value = 0;
  double variance = 0;
  for (const Sample& s : samples) {
    value += s.value;
    variance += s.variance;
  }
  const auto n = static_cast<double>(samples.size());
  return {static_cast<float>(value / n), static_cast<float>(variance / (n * n))};
}

absl::Status CheckRepeats(std::span<const MeasuredImage> repeats) {
  if (repeats.empty()) return BadInput("repeats", "there are none", "record at least one");
  for (size_t i = 1; i < repeats.size(); ++i) {
    if (repeats[i].size() != repeats[0].size() || repeats[i].unit != repeats[0].unit) {
      return BadInput(absl::StrCat("repeat ", i + 1), "size or unit differ from the first repeat's",
                      "average repeats of one measurement");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<MeasuredImage> AverageRepeats(std::span<const MeasuredImage> repeats,
                                             const AverageOptions& options) {
  EYEBOX_RETURN_IF_ERROR(CheckRepeats(repeats));
  MeasuredImage average = MakeMeasuredImage(repeats[0].size(), repeats[0].unit);
  size_t clipped = 0;
  std::vector<Sample> samples;
  for (size_t i = 0; i < average.mask.pixels().size(); ++i) {
    samples.clear();
    uint8_t reasons = 0;
    for (const MeasuredImage& repeat : repeats) {
      const uint8_t mask = repeat.mask.pixels()[i];
      reasons = static_cast<uint8_t>(reasons | mask);
      if (mask == 0) samples.push_back({repeat.value.pixels()[i], repeat.variance.pixels()[i]});
    }
    const size_t valid = samples.size();
    ClipOutliers(options.clip_sigmas, samples);
    clipped += valid - samples.size();
    if (valid > 0 && samples.empty()) reasons = kNoData;  // no two repeats agree
    average.mask.pixels()[i] = samples.empty() ? reasons : uint8_t{0};
    const Sample mean = Mean(samples);
    average.value.pixels()[i] = mean.value;
    average.variance.pixels()[i] = mean.variance;
  }
  BlankMaskedPixels(average);
  average.history = repeats[0].history;
  average.history.push_back(absl::StrCat("AverageRepeats(", repeats.size(), " repeats, clip ",
                                         options.clip_sigmas, " sigma, ", clipped, " left out)"));
  return average;
}

}  // namespace eyebox::optics
