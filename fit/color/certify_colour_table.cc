#include <algorithm>
#include <cmath>

#include "fit/color/colour_table.h"
#include "fit/color/drive_for_colour.h"
#include "fit/cube/sampling.h"

namespace eyebox::fit {
namespace {

constexpr double kTooBright = 1e-9;
constexpr std::array<int, 3> kHaltonBases = {2, 3, 5};

// The `index`-th number of van der Corput's sequence, in (0, 1): evenly spread, and the same each
// time.
double VanDerCorput(int index, int base) {
  double value = 0;
  double digit_weight = 1;
  for (int rest = index; rest > 0; rest /= base) {
    digit_weight /= base;
    value += digit_weight * (rest % base);
  }
  return value;
}

bool TooBright(const Rgb& drive) { return *std::ranges::max_element(drive) > 1 + kTooBright; }

struct ColourError {
  double luminance = 0;     // relative; of the black level where less is wanted
  double chromaticity = 0;  // u'v'
};

ColourError ErrorAt(const ColourModel& model, const ColourTable& table, const Rgb& u) {
  const Xyz wanted = table.goal.Wanted(u);
  const Xyz shown = model.Colour(DriveThroughColourTable(table, u));
  const double luminance = std::max(wanted[1], model.background[1]);
  return {shown[1] / luminance - 1, ChromaticityDistance(shown, wanted)};
}

Rgb Scaled(const Rgb& direction, double t) {
  return {t * direction[0], t * direction[1], t * direction[2]};
}

// The largest t up to 1 at which no channel needs more than full drive.
double Reachable(const ColourModel& model, const ColourGoal& goal, const Rgb& direction) {
  constexpr int kBisections = 40;
  double shown = 0;
  double not_shown = 1;
  if (!TooBright(DriveForColour(model, goal.Wanted(direction)).drive)) return 1;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = (shown + not_shown) / 2;
    const Rgb drive = DriveForColour(model, goal.Wanted(Scaled(direction, middle))).drive;
    (TooBright(drive) ? not_shown : shown) = middle;
  }
  return shown;
}

RampCertificate CertifyRamp(const ColourModel& model, const ColourTableOptions& options,
                            const ColourTable& table, const Rgb& direction) {
  RampCertificate ramp;
  ramp.luminance.u_from = options.u_from;
  ramp.luminance.samples = options.samples;
  std::vector<double> places;
  for (int i = 0; i < options.samples; ++i) {
    places.push_back(std::pow(options.u_from, 1 - static_cast<double>(i) / (options.samples - 1)));
  }
  double squares = 0;
  for (size_t i = 0; i < places.size() + table.knots_u.size(); ++i) {
    const bool at_knot = i >= places.size();
    const double t = at_knot ? table.knots_u[i - places.size()] / table.white_u : places[i];
    if (at_knot && !(t > options.u_from && t < 1)) continue;
    const ColourError error = ErrorAt(model, table, Scaled(direction, t));
    if (!at_knot) squares += error.luminance * error.luminance;
    if (std::abs(error.luminance) > ramp.luminance.max_relative) {
      ramp.luminance.max_relative = std::abs(error.luminance);
      ramp.luminance.at_u = t;
    }
    if (error.chromaticity > ramp.max_chromaticity_error) {
      ramp.max_chromaticity_error = error.chromaticity;
      ramp.at_u_chromaticity = t;
    }
  }
  ramp.luminance.rms_relative = std::sqrt(squares / options.samples);
  ramp.u_reachable = Reachable(model, table.goal, direction);
  return ramp;
}

InteriorCertificate CertifyInterior(const ColourModel& model, const ColourTableOptions& options,
                                    const ColourTable& table) {
  InteriorCertificate interior;
  double luminance_squares = 0;
  double chromaticity_squares = 0;
  for (int i = 1; i <= options.samples; ++i) {
    Rgb u;
    for (size_t k = 0; k < 3; ++k) {
      u[k] = std::lerp(options.u_from, 1.0, VanDerCorput(i, kHaltonBases[k]));
    }
    const ColourDrive exact = DriveForColour(model, table.goal.Wanted(u));
    if (!exact.saturation_reached || TooBright(exact.drive)) {
      ++interior.colours_outside;
      continue;
    }
    ++interior.colours;
    const ColourError error = ErrorAt(model, table, u);
    luminance_squares += error.luminance * error.luminance;
    chromaticity_squares += error.chromaticity * error.chromaticity;
    interior.max_relative = std::max(interior.max_relative, std::abs(error.luminance));
    interior.max_chromaticity_error = std::max(interior.max_chromaticity_error, error.chromaticity);
  }
  const int count = std::max(interior.colours, 1);
  interior.rms_relative = std::sqrt(luminance_squares / count);
  interior.rms_chromaticity_error = std::sqrt(chromaticity_squares / count);
  return interior;
}

// Where a rendered value lies between two entries of an axis.
struct Cell {
  size_t below = 0;
  double weight = 0;  // of the entry above
};

Cell CellOf(const ColourTable& table, double u) {
  const double position = PositionOf(table.target, table.size, u * table.white_u);
  const double below = std::clamp(std::floor(position), 0.0, table.size - 2.0);
  return {static_cast<size_t>(below), position - below};
}

}  // namespace

Rgb DriveThroughColourTable(const ColourTable& table, const Rgb& u) {
  const std::array<Cell, 3> cells = {CellOf(table, u[0]), CellOf(table, u[1]), CellOf(table, u[2])};
  const auto size = static_cast<size_t>(table.size);
  Rgb entry = {};
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1;
    size_t index = 0;
    for (size_t k = 3; k-- > 0;) {
      const bool above = (corner >> k & 1) != 0;
      weight *= above ? cells[k].weight : 1 - cells[k].weight;
      index = index * size + cells[k].below + (above ? 1 : 0);
    }
    for (size_t k = 0; k < 3; ++k) entry[k] += weight * table.cube.entries[index][k];
  }
  return {DriveOfEntry(table.target, entry[0]), DriveOfEntry(table.target, entry[1]),
          DriveOfEntry(table.target, entry[2])};
}

void CertifyColourTable(const ColourModel& model, const ColourTableOptions& options,
                        ColourTable& table) {
  table.ramps[0] = CertifyRamp(model, options, table, {1, 1, 1});
  table.ramps[0].name = "white";
  for (size_t k = 0; k < 3; ++k) {
    Rgb direction = {0, 0, 0};
    direction[k] = 1;
    table.ramps[k + 1] = CertifyRamp(model, options, table, direction);
    table.ramps[k + 1].name = kChannelNames[k];
  }
  table.interior = CertifyInterior(model, options, table);
}

}  // namespace eyebox::fit
