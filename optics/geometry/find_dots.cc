#include "optics/geometry/find_dots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kReach = 0.35;  // of the step: how far a dot may lie from where it is looked for
constexpr int kLeastSide = 3;
constexpr size_t kNoSpot = std::numeric_limits<size_t>::max();

struct Step {
  double x = 0;
  double y = 0;
};

struct Cell {
  size_t spot = 0;
  Step right;  // to the next dot, as far as is known here
  Step down;
};

using Place = std::pair<int, int>;  // column, row; of the first dot 0, 0

double Distance(const PixelPoint& a, const PixelPoint& b) {
  return std::hypot(a.x_px - b.x_px, a.y_px - b.y_px);
}

size_t Nearest(const std::vector<PixelPoint>& spots, const PixelPoint& to, double within) {
  size_t nearest = kNoSpot;
  for (size_t i = 0; i < spots.size(); ++i) {
    const double distance = Distance(spots[i], to);
    if (distance <= within) {
      within = distance;
      nearest = i;
    }
  }
  return nearest;
}

// The nearest neighbours to the right (within 45 deg) and below.
std::optional<Cell> FirstCell(const std::vector<PixelPoint>& spots) {
  PixelPoint middle;
  for (const PixelPoint& spot : spots) {
    middle.x_px += spot.x_px / static_cast<double>(spots.size());
    middle.y_px += spot.y_px / static_cast<double>(spots.size());
  }
  Cell cell;
  cell.spot = Nearest(spots, middle, std::numeric_limits<double>::infinity());
  double right = std::numeric_limits<double>::infinity();
  double down = right;
  for (const PixelPoint& spot : spots) {
    const Step step{spot.x_px - spots[cell.spot].x_px, spot.y_px - spots[cell.spot].y_px};
    const double length = std::hypot(step.x, step.y);
    if (step.x > std::abs(step.y) && length < right) {
      right = length;
      cell.right = step;
    }
    if (step.y >= std::abs(step.x) && length > 0 && length < down) {
      down = length;
      cell.down = step;
    }
  }
  if (!std::isfinite(right) || !std::isfinite(down)) return std::nullopt;
  return cell;
}

// Every spot that can be reached from the first, with its place.
std::map<Place, Cell> Walk(const std::vector<PixelPoint>& spots, const Cell& first) {
  std::map<Place, Cell> cells = {{{0, 0}, first}};
  std::set<size_t> taken = {first.spot};
  std::deque<Place> open = {{0, 0}};
  while (!open.empty()) {
    const Place at = open.front();
    open.pop_front();
    for (const auto& [columns, rows] : {Place{1, 0}, Place{-1, 0}, Place{0, 1}, Place{0, -1}}) {
      const Cell& cell = cells[at];
      const Place to = {at.first + columns, at.second + rows};
      if (cells.contains(to)) continue;
      const Step& along = columns != 0 ? cell.right : cell.down;
      const int sign = columns + rows;
      const PixelPoint& from = spots[cell.spot];
      const size_t found = Nearest(spots, {from.x_px + sign * along.x, from.y_px + sign * along.y},
                                   kReach * std::hypot(along.x, along.y));
      if (found == kNoSpot || taken.contains(found)) continue;
      Cell next = cell;
      next.spot = found;
      const Step real{sign * (spots[found].x_px - from.x_px),
                      sign * (spots[found].y_px - from.y_px)};
      (columns != 0 ? next.right : next.down) = real;
      cells[to] = next;
      taken.insert(found);
      open.push_back(to);
    }
  }
  return cells;
}

struct Extent {
  int left = 0, right = 0, top = 0, bottom = 0;
  int Columns() const { return right - left + 1; }
  int Rows() const { return bottom - top + 1; }
};

Extent ExtentOf(const std::map<Place, Cell>& cells) {
  Extent extent;
  for (const auto& [place, cell] : cells) {
    extent.left = std::min(extent.left, place.first);
    extent.right = std::max(extent.right, place.first);
    extent.top = std::min(extent.top, place.second);
    extent.bottom = std::max(extent.bottom, place.second);
  }
  return extent;
}

}  // namespace

absl::StatusOr<std::vector<Dot>> OrderDots(const std::vector<PixelPoint>& spots,
                                           const DotGrid& grid, std::string_view source) {
  if (grid.columns < kLeastSide || grid.rows < kLeastSide) {
    return BadInput("dot grid", absl::StrCat(grid.columns, " x ", grid.rows, " dots"),
                    "give at least 3 columns and 3 rows");
  }
  const std::string wanted = absl::StrCat(grid.columns, " x ", grid.rows);
  const auto first = FirstCell(spots);
  if (!first) {
    return Rejected(source, absl::StrCat("no grid among ", spots.size(), " spots"),
                    absl::StrCat("show all ", wanted, " dots, sharp and with contrast; are they ",
                                 grid.bright ? "brighter" : "darker", " than their surroundings?"));
  }
  const auto cells = Walk(spots, *first);
  const Extent extent = ExtentOf(cells);
  const bool upright = extent.Columns() == grid.columns && extent.Rows() == grid.rows;
  const bool turned = extent.Columns() == grid.rows && extent.Rows() == grid.columns;
  const auto complete = static_cast<size_t>(grid.columns) * grid.rows;
  if ((!upright && !turned) || cells.size() != complete) {
    return Rejected(source,
                    absl::StrCat("shows ", cells.size(), " dots in a grid of ", extent.Columns(),
                                 " x ", extent.Rows(), ", not ", wanted),
                    "give the columns and rows of the target, and keep all of it in view");
  }
  std::vector<Dot> dots;
  for (const auto& [place, cell] : cells) {
    const int column = place.first - extent.left;
    const int row = place.second - extent.top;
    // On its side, the target's first column is the lowest row that is seen.
    dots.push_back(upright ? Dot{column, row, spots[cell.spot]}
                           : Dot{grid.columns - 1 - row, column, spots[cell.spot]});
  }
  return dots;
}

absl::StatusOr<std::vector<Dot>> FindDots(const Image<double>& view, const DotGrid& grid,
                                          std::string_view source) {
  return OrderDots(FindSpots(view, grid.bright), grid, source);
}

}  // namespace eyebox::optics
