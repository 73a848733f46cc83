#include "fit/color/colour_table.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/color/drive_for_colour.h"
#include "fit/cube/minimax.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

constexpr int kSmallest = 2;
constexpr int kLargest = 129;
constexpr int kLargestStrip = 32;
constexpr double kStripTop = 255;
constexpr double kSameU = 1e-12;
constexpr double kTooBright = 1e-9;
// A shift beyond this is no balancing of interpolation errors but the end of the certified range.
constexpr double kLargestShift = 0.2;

absl::Status CheckSize(TableTarget target, int size) {
  const bool is_cube = target == TableTarget::kHdrp || target == TableTarget::kPps ||
                       target == TableTarget::kResolve;
  if (!is_cube) {
    return BadInput("target",
                    absl::StrCat(std::string(NameOf(target)),
                                 " holds one curve for each channel and cannot undo interactions"),
                    "choose hdrp, pps or resolve");
  }
  const int largest = target == TableTarget::kPps ? kLargestStrip : kLargest;
  if (size >= kSmallest && size <= largest) return absl::OkStatus();
  return BadInput("size", absl::StrCat(size, " is outside ", kSmallest, " to ", largest),
                  "choose a size within it");
}

// The different rendered values, as fractions of white, that the knots of an axis stand for. The
// last knot at or below 0 keeps its value, negative or not, so that interpolation hits 0 where HDRP
// has no knot; those below it follow it. What lies above white is the first knot at or above it,
// which may ask for more than full drive so that the last cell does not bend.
struct Axis {
  std::vector<double> levels;    // ascending
  std::vector<size_t> level_of;  // [size]
};

Axis MakeAxis(const std::vector<double>& knots_u, double white_u) {
  Axis axis;
  for (double knot : knots_u) {
    const double level = knot / white_u;
    if (axis.levels.empty() || (level <= 0 && axis.levels.size() == 1)) {
      axis.levels.assign(1, level);
    } else if (axis.levels.back() < 1 - kSameU) {
      axis.levels.push_back(level);
    }
    axis.level_of.push_back(axis.levels.size() - 1);
  }
  return axis;
}

// How one channel answers along grey, where its neighbours are driven alike.
struct AlongGrey {
  double cutoff_drive = 0;
  double full = 1;  // activation at full drive
};

AlongGrey AnswerAlongGrey(const ColourModel& model, size_t channel) {
  const Matrix3 c = model.Interaction();
  const double all = c[channel][0] + c[channel][1] + c[channel][2];
  const double full = model.Activations({1, 1, 1})[channel];
  if (model.kind == ColourModelKind::kActivationGain) return {model.cutoff_drive[channel], full};
  return {model.cutoff_drive[channel] / (1 + all), full};
}

// Factor of each entry of `channel`, [size]: minimax over ideal entries of the channel along grey.
// Its full drive stands for more than white where white is not the display's brightest.
std::vector<double> ShiftsOf(const ColourModel& model, const ColourTable& table, size_t channel,
                             const ColourTableOptions& options) {
  std::vector<double> shifts(table.size, 1.0);
  if (table.target == TableTarget::kPps) return shifts;
  const AlongGrey grey = AnswerAlongGrey(model, channel);
  const double black = std::max(WeightsFor(model.primaries, model.background)[channel], 0.0);
  const double at_white = WeightsFor(model.primaries, table.goal.White())[channel];
  const double full_drive_x = std::max((grey.full + black) / at_white, 1.0);
  const Activation activation{black / grey.full, 1, grey.cutoff_drive, model.gamma[channel]};
  const double white_u = table.white_u * full_drive_x;
  auto points =
      DesignPoints(activation, table.target, table.size, white_u, options.u_from / full_drive_x);
  std::erase_if(points, [&](const DesignPoint& p) { return p.x * full_drive_x > 1 + kSameU; });
  if (points.empty()) return shifts;
  const auto ideal = IdealEntries(activation, table.target, table.size, white_u);
  const auto minimax = MinimaxEntries(activation, table.target, table.size, white_u, points);
  for (int i = 0; i < table.size; ++i) {
    const bool beyond = i > 0 && table.knots_u[i - 1] >= table.white_u * (1 - kSameU);
    const double shift = ideal[i] > 0 ? minimax[i] / ideal[i] : 1;
    if (beyond) {
      shifts[i] = shifts[i - 1];
    } else if (table.knots_u[i] >= 0 && std::abs(shift - 1) <= kLargestShift) {
      shifts[i] = shift;
    }
  }
  return shifts;
}

double Stored(TableTarget target, double entry) {
  if (target != TableTarget::kPps) return static_cast<float>(entry);
  return std::round(kStripTop * std::min(entry, 1.0)) / kStripTop;
}

void Count(const ColourModel& model, const Xyz& wanted, const ColourDrive& reached,
           EntryCount& count) {
  ++count.in_range;
  count.too_bright += *std::ranges::max_element(reached.drive) > 1 + kTooBright ? 1 : 0;
  if (reached.saturation_reached) return;
  ++(reached.inside_gamut ? count.limited_by_black : count.outside_gamut);
  const double distance = ChromaticityDistance(NearestInGamut(model, wanted), wanted);
  count.max_chromaticity_error = std::max(count.max_chromaticity_error, distance);
}

// [levels^3], red fastest: the drive values of all different colours, counted on the way.
std::vector<Rgb> DrivesOf(const ColourModel& model, const Axis& axis, ColourTable& table) {
  std::vector<Rgb> drives;
  drives.reserve(axis.levels.size() * axis.levels.size() * axis.levels.size());
  for (double blue : axis.levels) {
    for (double green : axis.levels) {
      for (double red : axis.levels) {
        const Xyz wanted = table.goal.Wanted({red, green, blue});
        const ColourDrive reached = DriveForColour(model, wanted);
        drives.push_back(reached.drive);
        if (std::min({red, green, blue}) < 0 || std::max({red, green, blue}) > 1 + kSameU) continue;
        Count(model, wanted, reached, table.entries);
      }
    }
  }
  return drives;
}

void FillEntries(const ColourModel& model, const ColourTableOptions& options, ColourTable& table) {
  const Axis axis = MakeAxis(table.knots_u, table.white_u);
  const std::vector<Rgb> drives = DrivesOf(model, axis, table);
  std::array<std::vector<double>, 3> shifts;
  for (size_t k = 0; k < 3; ++k) shifts[k] = ShiftsOf(model, table, k, options);
  const size_t count = axis.levels.size();
  const auto size = static_cast<size_t>(table.size);
  table.cube.entries.reserve(size * size * size);
  for (size_t blue = 0; blue < size; ++blue) {
    for (size_t green = 0; green < size; ++green) {
      for (size_t red = 0; red < size; ++red) {
        const std::array<size_t, 3> at = {red, green, blue};
        const size_t level =
            axis.level_of[red] + count * (axis.level_of[green] + count * axis.level_of[blue]);
        std::array<double, 3> entry{};
        for (size_t k = 0; k < 3; ++k) {
          entry[k] =
              Stored(table.target, shifts[k][at[k]] * EntryOfDrive(table.target, drives[level][k]));
        }
        table.cube.entries.push_back(entry);
      }
    }
  }
}

}  // namespace

absl::Status ColourTableOptions::Validate() const {
  if (!(white_u > 0 && std::isfinite(white_u))) {
    return BadInput("white_u", absl::StrCat(white_u, " is not above 0"), "give a rendered value");
  }
  if (!(u_from > 0 && u_from < 1)) {
    return BadInput("u_from", absl::StrCat(u_from, " is not between 0 and 1"),
                    "give a fraction of white");
  }
  if (samples < 2) {
    return BadInput("samples", absl::StrCat(samples, " is too few"), "give 2 or more");
  }
  return absl::OkStatus();
}

absl::StatusOr<ColourTable> DesignColourTable(const ColourModel& model, TableTarget target,
                                              int size, const ColourTableOptions& options) {
  EYEBOX_RETURN_IF_ERROR(model.Validate("colour model"));
  EYEBOX_RETURN_IF_ERROR(CheckSize(target, size));
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  if (options.white_u > LargestU(target)) {
    return BadInput("white_u",
                    absl::StrCat(options.white_u, " lies beyond the table's axis, which ends at ",
                                 LargestU(target)),
                    "choose a smaller rendered value for white");
  }
  ColourTable table;
  table.target = target;
  table.size = size;
  table.white_u = options.white_u;
  EYEBOX_ASSIGN_OR_RETURN(table.goal, MakeColourGoal(model, options.goal));
  for (int i = 0; i < size; ++i) table.knots_u.push_back(UAtPosition(target, size, i));
  table.cube.size = size;
  table.cube.title = absl::StrCat("Eyebox, colour, for ", std::string(NameOf(target)), ", size ",
                                  size, ", gamut ", std::string(NameOf(options.goal.gamut)));
  FillEntries(model, options, table);
  CertifyColourTable(model, options, table);
  return table;
}

absl::StatusOr<std::string> EncodeColourTable(const ColourTable& table) {
  if (table.target == TableTarget::kPps) return EncodeStrip(table.cube);
  return EncodeCube(table.cube);
}

}  // namespace eyebox::fit
