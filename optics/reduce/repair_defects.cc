#include "optics/reduce/repair_defects.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"

namespace eyebox::optics {
namespace {

// NaN where none is valid.
float MeanOfNeighbours(const MeasuredImage& image, int x, int y, int step) {
  const auto [width, height] = image.size();
  float sum = 0;
  float count = 0;
  for (int row = y - step; row <= y + step; row += step) {
    for (int column = x - step; column <= x + step; column += step) {
      if (row < 0 || row >= height || column < 0 || column >= width) continue;
      if (image.mask.at(column, row) != 0) continue;
      sum += image.value.at(column, row);
      ++count;
    }
  }
  return count > 0 ? sum / count : kNoValue;
}

}  // namespace

MeasuredImage RepairDefects(MeasuredImage image, int colour_period_px) {
  size_t repaired = 0;
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      if (image.mask.at(x, y) != kDefective) continue;
      const float mean = MeanOfNeighbours(image, x, y, colour_period_px);
      if (std::isnan(mean)) continue;
      image.value.at(x, y) = mean;
      image.mask.at(x, y) = kDefective | kRepaired;
      ++repaired;
    }
  }
  image.history.push_back(
      absl::StrCat("RepairDefects(", repaired, " pixels filled from neighbours, still invalid)"));
  return image;
}

}  // namespace eyebox::optics
