#include "service/steps/photodiode.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "capture/base/status.h"
#include "service/steps/captures.h"

namespace eyebox::service {
namespace {

constexpr double kLargestClippedShare = 0.05;
constexpr int32_t kLowestRail = 255;  // of a converter of 8 bits; the recording does not name it

using capture::PhotodiodeSample;

// Whether many counts are all ones in binary, as on the rail of a converter.
bool IsClipped(const std::vector<PhotodiodeSample>& samples) {
  const int32_t highest = std::ranges::max_element(samples, {}, &PhotodiodeSample::counts)->counts;
  if (highest < kLowestRail || !std::has_single_bit(static_cast<uint32_t>(highest) + 1)) {
    return false;
  }
  const auto at_rail = std::ranges::count(samples, highest, &PhotodiodeSample::counts);
  return static_cast<double>(at_rail) > kLargestClippedShare * static_cast<double>(samples.size());
}

// The window reaches half a mean sample period beyond the first and the last.
PhotodiodeMean HannMean(const std::vector<PhotodiodeSample>& samples) {
  const auto count = static_cast<double>(samples.size());
  const int64_t first_ns = samples.front().monotonic_ns;
  const auto span_ns = static_cast<double>(samples.back().monotonic_ns - first_ns);
  const double margin_ns = samples.size() > 1 ? 0.5 * span_ns / (count - 1) : 1;
  double sum = 0;
  double weights = 0;
  for (const PhotodiodeSample& sample : samples) {
    const double since_ns = static_cast<double>(sample.monotonic_ns - first_ns) + margin_ns;
    const double sine = std::sin(std::numbers::pi * since_ns / (span_ns + 2 * margin_ns));
    sum += sine * sine * sample.counts;
    weights += sine * sine;
  }
  return {sum / weights, static_cast<int64_t>(samples.size()), IsClipped(samples)};
}

absl::StatusOr<std::optional<PhotodiodeMean>> StatedByFrames(capture::RecordingReader& recording,
                                                             const capture::CaptureEntry& entry) {
  PhotodiodeMean mean;
  EYEBOX_RETURN_IF_ERROR(recording.VisitFrames(entry, [&mean](const Frame& frame) {
    const std::optional<double>& counts = frame.metadata.photodiode_counts;
    if (!counts || !std::isfinite(*counts)) return absl::OkStatus();
    mean.counts += *counts;
    ++mean.readings;
    return absl::OkStatus();
  }));
  if (mean.readings == 0) return std::nullopt;
  mean.counts /= static_cast<double>(mean.readings);
  return mean;
}

}  // namespace

absl::StatusOr<std::optional<PhotodiodeMean>> ReadPhotodiode(capture::RecordingReader& recording,
                                                             const capture::CaptureEntry& entry) {
  if (entry.sample_count > 0) {
    std::vector<PhotodiodeSample> samples;
    EYEBOX_RETURN_IF_ERROR(
        recording.VisitSamples(entry, [&samples](const capture::SampleBlock& block) {
          samples.insert(samples.end(), block.samples.begin(), block.samples.end());
          return absl::OkStatus();
        }));
    if (samples.empty()) return std::nullopt;
    return HannMean(samples);
  }
  EYEBOX_ASSIGN_OR_RETURN(const FrameMetadata first, FirstMetadata(recording, entry));
  if (!first.photodiode_counts) return std::nullopt;
  return StatedByFrames(recording, entry);
}

}  // namespace eyebox::service
