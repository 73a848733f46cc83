#include "optics/sensor/emva1288/read_series.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/image_file.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

double MeanOf(const Stack& stack) {
  double sum = 0;
  for (const float mean : stack.mean_dn.pixels()) sum += mean;
  return sum / static_cast<double>(stack.size().PixelCount());
}

// Ties go to the stack of more images.
bool IsBetter(double score, double best, const Stack& stack, const Stack& other) {
  return score < best || (score == best && stack.frames > other.frames);
}

absl::Status AddImage(const DescribedImage& image, ImageSize size, const std::string& where,
                      SetAccumulator& set) {
  const absl::StatusOr<StillImage> still = ReadGreyImage(image.file);
  if (!still.ok()) {
    return {still.status().code(), absl::StrCat(where, ": ", still.status().message())};
  }
  const ImageSize found = still->pixels_dn.size();
  if (found != size) {
    return BadInput(
        where,
        absl::StrCat(image.file.string(), " has ", found.width_px, " x ", found.height_px,
                     " pixels, the n line says ", size.width_px, " x ", size.height_px),
        "mend the n line or the image");
  }
  return set.Add({still->pixels_dn.pixels(), found});
}

}  // namespace

void SeriesCollector::Add(SetAccumulator::Finished set) {
  Stack& stack = set.stack;
  const double exposure_s = stack.setting.exposure_s;
  sets.push_back(std::move(set.statistics));
  if (!sets.back().condition.dark) {
    const double half = 0.5 * stack.range.FullScaleDn();
    const double distance = std::abs(MeanOf(stack) - half);
    if (!half_bright ||
        IsBetter(distance, std::abs(MeanOf(*half_bright) - half), stack, *half_bright)) {
      half_bright = std::move(stack);
    }
    return;
  }
  if (!longest_dark ||
      IsBetter(-exposure_s, -longest_dark->setting.exposure_s, stack, *longest_dark)) {
    longest_dark = stack;
  }
  if (!shortest_dark ||
      IsBetter(exposure_s, shortest_dark->setting.exposure_s, stack, *shortest_dark)) {
    shortest_dark = std::move(stack);
  }
}

absl::StatusOr<SeriesCollector> ReadSeries(const Emva1288Descriptor& descriptor,
                                           const std::string& name, int colour_period_px) {
  SeriesCollector series;
  for (const DescribedSet& set : descriptor.sets) {
    SetCondition condition;
    condition.where = absl::StrCat(name, ":", set.line);
    condition.dark = set.dark;
    condition.exposure_s = set.exposure_ns * 1e-9;
    condition.irradiation = set.photons;
    SetAccumulator accumulator(condition, {descriptor.bits}, colour_period_px);
    for (const DescribedImage& image : set.images) {
      EYEBOX_RETURN_IF_ERROR(
          AddImage(image, descriptor.size, absl::StrCat(name, ":", image.line), accumulator));
    }
    EYEBOX_ASSIGN_OR_RETURN(SetAccumulator::Finished finished, accumulator.Finish());
    series.Add(std::move(finished));
  }
  return series;
}

}  // namespace eyebox::optics
