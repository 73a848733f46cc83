#include "service/steps/field_regions.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "capture/base/status.h"

namespace eyebox::service {
namespace {

constexpr int kCellsPerRegionSide = 12;
constexpr int kFewestCells = 8;       // of a region: fewer tell little of its noise
constexpr double kFewestValid = 0.5;  // share of a cell's pixels

struct Cell {
  int left = 0, right = 0, top = 0, bottom = 0;  // [left, right), pixels
  int region = 0;
};

// Cells of at least a pixel; small fields have fewer of them.
std::vector<Cell> CellsOf(ImageSize size) {
  const int columns = std::min(size.width_px, kRegionsPerSide * kCellsPerRegionSide);
  const int rows = std::min(size.height_px, kRegionsPerSide * kCellsPerRegionSide);
  std::vector<Cell> cells;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      cells.push_back(
          {column * size.width_px / columns, (column + 1) * size.width_px / columns,
           row * size.height_px / rows, (row + 1) * size.height_px / rows,
           row * kRegionsPerSide / rows * kRegionsPerSide + column * kRegionsPerSide / columns});
    }
  }
  return cells;
}

// The cell's pixels with a value at every level, as places in a level.
std::vector<size_t> ValidPixels(const MeasuredLevels& levels, const Cell& cell) {
  std::vector<size_t> places;
  for (int y = cell.top; y < cell.bottom; ++y) {
    for (int x = cell.left; x < cell.right; ++x) {
      const size_t place = static_cast<size_t>(y) * levels.size.width_px + x;
      if (levels.valid[place] != 0) places.push_back(place);
    }
  }
  return places;
}

struct CellReadings {
  std::vector<std::vector<double>> means;  // [cells][levels]
  std::vector<int> regions;                // [cells]
};

CellReadings Average(const MeasuredLevels& levels) {
  CellReadings readings;
  const size_t pixels = levels.size.PixelCount();
  for (const Cell& cell : CellsOf(levels.size)) {
    const std::vector<size_t> places = ValidPixels(levels, cell);
    const int area = (cell.right - cell.left) * (cell.bottom - cell.top);
    if (places.empty() || static_cast<double>(places.size()) < kFewestValid * area) continue;
    std::vector<double> means;
    for (size_t level = 0; level < levels.drives.size(); ++level) {
      double sum = 0;
      for (const size_t place : places) sum += levels.luminance[level * pixels + place];
      means.push_back(sum / static_cast<double>(places.size()));
    }
    readings.means.push_back(std::move(means));
    readings.regions.push_back(cell.region);
  }
  return readings;
}

void LeaveOutSparseRegions(std::vector<int>& regions) {
  const std::vector<int> all = regions;
  for (int& region : regions) {
    if (std::count(all.begin(), all.end(), region) < kFewestCells) region = -1;
  }
}

}  // namespace

absl::StatusOr<FieldRegions> CompareFieldRegions(const MeasuredLevels& levels, bool with_cutoff) {
  CellReadings readings = Average(levels);
  LeaveOutSparseRegions(readings.regions);
  std::vector<float> luminance;
  for (size_t level = 0; level < levels.drives.size(); ++level) {
    for (const std::vector<double>& means : readings.means) {
      luminance.push_back(static_cast<float>(means[level]));
    }
  }
  const fit::MaskedStack stack{levels.drives, luminance, {}};
  EYEBOX_ASSIGN_OR_RETURN(const fit::FieldWeights weights, fit::RelativeFieldWeights(stack));
  fit::SharedExponentOptions options;
  options.with_cutoff = with_cutoff;
  FieldRegions regions;
  EYEBOX_ASSIGN_OR_RETURN(regions.comparison,
                          fit::CompareRegions(stack, weights, readings.regions, options));
  return regions;
}

}  // namespace eyebox::service
