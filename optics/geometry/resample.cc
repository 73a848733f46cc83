#include "optics/geometry/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "optics/geometry/solid_angle.h"

namespace eyebox::optics {
namespace {

constexpr double kWidestDeg = 80;
constexpr int kMostParts = 64;  // a side of a pixel
constexpr size_t kMostCells = size_t{64} << 20;

// Sums over the parts in each cell; a pixel's whole weight in a cell is squared for the variance.
class Cells {
 public:
  explicit Cells(ImageSize size) : weight(size), sum(size), variance(size), flags(size) {}

  void Add(size_t cell, double part_sr, float value, float pixel_variance) {
    weight.pixels()[cell] += part_sr;
    sum.pixels()[cell] += part_sr * value;
    variance.pixels()[cell] += part_sr * part_sr * pixel_variance;
  }

  Image<double> weight, sum, variance;
  Image<uint8_t> flags;
};

// In how many cells, and how much in each, a pixel lies: few, so a list is searched.
class PixelShares {
 public:
  void Add(size_t cell) {
    const auto at = std::ranges::find(shares_, cell, &std::pair<size_t, int>::first);
    if (at == shares_.end()) {
      shares_.emplace_back(cell, 1);
    } else {
      ++at->second;
    }
  }
  void Clear() { shares_.clear(); }
  const std::vector<std::pair<size_t, int>>& Shares() const { return shares_; }

 private:
  std::vector<std::pair<size_t, int>> shares_;
};

std::optional<size_t> CellOf(const FieldGrid& grid, const FieldAngle& angle) {
  const double column = std::floor((angle.horizontal_deg - grid.left_deg) / grid.step_deg + 0.5);
  const double row = std::floor((grid.top_deg - angle.vertical_deg) / grid.step_deg + 0.5);
  if (!(column >= 0 && column < grid.size.width_px && row >= 0 && row < grid.size.height_px)) {
    return std::nullopt;
  }
  return static_cast<size_t>(row) * static_cast<size_t>(grid.size.width_px) +
         static_cast<size_t>(column);
}

// The angles of a pixel's middle and how they change across it: within a pixel the lens is linear.
struct PixelFrame {
  FieldAngle middle, by_x, by_y;

  FieldAngle At(double x, double y) const {
    return {middle.horizontal_deg + x * by_x.horizontal_deg + y * by_y.horizontal_deg,
            middle.vertical_deg + x * by_x.vertical_deg + y * by_y.vertical_deg};
  }
  double LargestSideDeg() const {
    return std::max({std::abs(by_x.horizontal_deg), std::abs(by_x.vertical_deg),
                     std::abs(by_y.horizontal_deg), std::abs(by_y.vertical_deg)});
  }
};

FieldAngle Half(const FieldAngle& a, const FieldAngle& b) {
  return {(a.horizontal_deg - b.horizontal_deg) / 2, (a.vertical_deg - b.vertical_deg) / 2};
}

using AngleRow = std::vector<std::optional<FieldAngle>>;

AngleRow AnglesOfRow(const ViewGeometry& geometry, const Rotation& turn, int y) {
  AngleRow angles;
  for (int x = -1; x <= geometry.camera.size.width_px; ++x) {
    const auto direction = geometry.camera.DirectionOf({1.0 * x, 1.0 * y});
    angles.push_back(direction ? FieldAngleOf(Rotate(turn, *direction)) : std::nullopt);
  }
  return angles;
}

// rows[0] above, rows[1] here, rows[2] below; column x stands at x + 1.
std::optional<PixelFrame> FrameOf(const std::array<AngleRow, 3>& rows, int x) {
  const size_t i = static_cast<size_t>(x) + 1;
  if (!rows[1][i] || !rows[1][i - 1] || !rows[1][i + 1] || !rows[0][i] || !rows[2][i]) {
    return std::nullopt;
  }
  return PixelFrame{*rows[1][i], Half(*rows[1][i + 1], *rows[1][i - 1]),
                    Half(*rows[2][i], *rows[0][i])};
}

void Spread(const PixelFrame& frame, const FieldGrid& grid, PixelShares& shares, int& parts) {
  parts = std::clamp(static_cast<int>(std::ceil(2 * frame.LargestSideDeg() / grid.step_deg)), 1,
                     kMostParts);
  shares.Clear();
  for (int j = 0; j < parts; ++j) {
    for (int i = 0; i < parts; ++i) {
      const auto cell = CellOf(grid, frame.At((i + 0.5) / parts - 0.5, (j + 0.5) / parts - 0.5));
      if (cell) shares.Add(*cell);
    }
  }
}

FieldMap Finish(const Cells& cells, const FieldGrid& grid, const ResampleOptions& options,
                const MeasuredImage& source) {
  FieldMap map{grid, MakeMeasuredImage(grid.size, source.unit), cells.weight};
  const double half_deg = grid.step_deg / 2;
  for (int row = 0; row < grid.size.height_px; ++row) {
    for (int column = 0; column < grid.size.width_px; ++column) {
      const FieldAngle centre = grid.CentreOf(column, row);
      const double whole_sr =
          SolidAngleSr({centre.horizontal_deg - half_deg, centre.vertical_deg - half_deg},
                       {centre.horizontal_deg + half_deg, centre.vertical_deg + half_deg});
      const double weight = cells.weight.at(column, row);
      if (weight > 0 && weight >= options.least_coverage * whole_sr) {
        map.image.value.at(column, row) = static_cast<float>(cells.sum.at(column, row) / weight);
        map.image.variance.at(column, row) =
            static_cast<float>(cells.variance.at(column, row) / (weight * weight));
        continue;
      }
      const uint8_t flags = cells.flags.at(column, row);
      map.image.mask.at(column, row) = flags != 0 ? flags : static_cast<uint8_t>(kNoData);
    }
  }
  BlankMaskedPixels(map.image);
  map.image.history = source.history;
  map.image.history.push_back(absl::StrFormat(
      "ResampleToField(%d x %d cells of %g deg, from %g deg left, %g deg top, coverage %g)",
      grid.size.width_px, grid.size.height_px, grid.step_deg, grid.left_deg, grid.top_deg,
      options.least_coverage));
  return map;
}

}  // namespace

FieldAngle FieldGrid::CentreOf(int column, int row) const {
  return {left_deg + column * step_deg, top_deg - row * step_deg};
}

absl::Status FieldGrid::Validate() const {
  if (!(step_deg > 0) || !std::isfinite(step_deg)) {
    return BadInput("field grid", absl::StrCat("step ", step_deg, " deg"), "give one above 0");
  }
  if (size.width_px < 1 || size.height_px < 1 || size.PixelCount() > kMostCells) {
    return BadInput("field grid", absl::StrCat(size.width_px, " x ", size.height_px, " cells"),
                    "give at least 1 x 1 and at most 64 million");
  }
  const FieldAngle first = CentreOf(0, 0);
  const FieldAngle last = CentreOf(size.width_px - 1, size.height_px - 1);
  for (const double angle :
       {first.horizontal_deg, first.vertical_deg, last.horizontal_deg, last.vertical_deg}) {
    if (std::abs(angle) + step_deg / 2 < 90) continue;
    return BadInput("field grid", absl::StrCat("reaches ", angle, " deg"),
                    "field angles end at 90 deg");
  }
  return absl::OkStatus();
}

absl::StatusOr<FieldGrid> GridOver(const ViewGeometry& geometry, double step_deg) {
  if (!(step_deg > 0) || !std::isfinite(step_deg)) {
    return BadInput("field grid", absl::StrCat("step ", step_deg, " deg"), "give one above 0");
  }
  const Rotation turn = geometry.pupil.RotationHeadsetCamera();
  double left = kWidestDeg;
  double right = -kWidestDeg;
  double bottom = kWidestDeg;
  double top = -kWidestDeg;
  for (int y = 0; y < geometry.camera.size.height_px; ++y) {
    for (const auto& angle : AnglesOfRow(geometry, turn, y)) {
      if (!angle || std::abs(angle->horizontal_deg) > kWidestDeg ||
          std::abs(angle->vertical_deg) > kWidestDeg) {
        continue;
      }
      left = std::min(left, angle->horizontal_deg);
      right = std::max(right, angle->horizontal_deg);
      bottom = std::min(bottom, angle->vertical_deg);
      top = std::max(top, angle->vertical_deg);
    }
  }
  if (!(left <= right)) {
    return Rejected("field grid", "the camera sees nothing within 80 deg", "check its geometry");
  }
  const auto cells = [step_deg](double from, double to) {
    return static_cast<int>(std::round((to - from) / step_deg)) + 1;
  };
  FieldGrid grid;
  grid.step_deg = step_deg;
  grid.left_deg = step_deg * std::round(left / step_deg);
  grid.top_deg = step_deg * std::round(top / step_deg);
  grid.size = {cells(grid.left_deg, step_deg * std::round(right / step_deg)),
               cells(step_deg * std::round(bottom / step_deg), grid.top_deg)};
  EYEBOX_RETURN_IF_ERROR(grid.Validate());
  return grid;
}

absl::StatusOr<FieldMap> ResampleToField(const MeasuredImage& image, const ViewGeometry& geometry,
                                         const FieldGrid& grid, const ResampleOptions& options) {
  EYEBOX_RETURN_IF_ERROR(grid.Validate());
  EYEBOX_ASSIGN_OR_RETURN(const Image<double> solid_angle_sr, PixelSolidAnglesSr(geometry.camera));
  if (image.size() != geometry.camera.size) {
    return BadInput(
        "geometry",
        absl::StrCat("of ", geometry.camera.size.width_px, " x ", geometry.camera.size.height_px,
                     " px, the map has ", image.size().width_px, " x ", image.size().height_px),
        "calibrate with the region of interest and binning of the measurement");
  }
  const Rotation turn = geometry.pupil.RotationHeadsetCamera();
  Cells cells(grid.size);
  PixelShares shares;
  int parts = 1;
  std::array<AngleRow, 3> rows = {AnglesOfRow(geometry, turn, -1), AnglesOfRow(geometry, turn, 0),
                                  AnglesOfRow(geometry, turn, 1)};
  for (int y = 0; y < image.size().height_px; ++y) {
    for (int x = 0; x < image.size().width_px; ++x) {
      const auto frame = FrameOf(rows, x);
      if (!frame) continue;
      Spread(*frame, grid, shares, parts);
      for (const auto& [cell, count] : shares.Shares()) {
        const uint8_t mask = image.mask.at(x, y);
        if (mask != 0) {
          cells.flags.pixels()[cell] |= mask;
          continue;
        }
        cells.Add(cell, solid_angle_sr.at(x, y) * count / (parts * parts), image.value.at(x, y),
                  image.variance.at(x, y));
      }
    }
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    rows[2] = AnglesOfRow(geometry, turn, y + 2);
  }
  return Finish(cells, grid, options, image);
}

}  // namespace eyebox::optics
