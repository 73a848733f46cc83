// Lookup tables: their axis, their sampling, and the drive value that a luminance asks for.
#include <algorithm>
#include <array>
#include <cmath>

#include "capture/base/random.h"
#include "fit/cube/goal.h"
#include "fit/cube/sampling.h"
#include "optics/render/colour_table.h"
#include "tests/tools/numerics/activation_shapes.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

using Rgb = optics::Rgb;

Digits50 Position50(int size, double u) {
  Digits50 axis =
      Digits50("0.244161") * log10(Digits50(Digits50("5.555556") * u + Digits50("0.047996"))) +
      Digits50("0.386036");
  if (axis > 1) axis = 1;
  return axis * (size - 1);
}

void AddAxis(Density density, std::vector<Row>& rows) {
  WorstCase position("PositionOf, HDRP", 1e-15, Measure::kOfScale);
  for (const int size : {2, 3, 16, 32, 33, 64, 129}) {
    for (const double u : LogSteps(1e-9, 58.9, 60 * density.steps)) {
      position.Compare(fit::PositionOf(fit::TableTarget::kHdrp, size, u), Position50(size, u),
                       {{"size", static_cast<double>(size)}, {"u", u}}, size - 1);
    }
  }
  rows.push_back(position.row());
}

Digits50 Trilinear50(const optics::ColourTable& table, const Rgb& position, size_t channel) {
  std::array<int, 3> below;
  std::array<Digits50, 3> weight;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double inside = std::clamp(position[axis], 0.0, table.size - 1.0);
    below[axis] = std::min(static_cast<int>(inside), table.size - 2);
    weight[axis] = Digits50(inside) - below[axis];
  }
  Digits50 sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Digits50 share = 1;
    size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int up = corner >> axis & 1;
      share *= up != 0 ? weight[axis] : 1 - weight[axis];
      index = index * table.size + below[axis] + up;
    }
    sum += share * table.entries[index][channel];
  }
  return sum;
}

void AddSampling(Density density, std::vector<Row>& rows) {
  WorstCase trilinear("SampleTrilinear", 1e-15, Measure::kOfScale);
  WorstCase linear("Interpolate", 1e-15, Measure::kOfScale);
  RandomStream random({3, 2});
  for (const int size : {2, 3, 32, 65}) {
    optics::ColourTable table{size, {}};
    const size_t count = static_cast<size_t>(size) * size * size;
    for (size_t i = 0; i < count; ++i) {
      table.entries.push_back({random.Uniform(), random.Uniform(), random.Uniform()});
    }
    std::vector<double> line;
    for (int i = 0; i < size; ++i) line.push_back(random.Uniform());
    for (int trial = 0; trial < 200 * density.steps; ++trial) {
      Rgb position;
      for (double& p : position) p = (size - 1) * (1.1 * random.Uniform() - 0.05);
      const Rgb value = optics::SampleTrilinear(table, position);
      for (size_t channel = 0; channel < 3; ++channel) {
        trilinear.Compare(value[channel], Trilinear50(table, position, channel),
                          {{"size", static_cast<double>(size)}, {"red at", position[0]}});
      }
      const double at = std::clamp(position[0], 0.0, size - 1.0);
      const int below = std::min(static_cast<int>(at), size - 2);
      const Digits50 share = Digits50(at) - below;
      linear.Compare(fit::Interpolate(line, at),
                     (1 - share) * line[below] + share * line[below + 1],
                     {{"size", static_cast<double>(size)}, {"at", at}});
    }
  }
  rows.push_back(trilinear.row());
  rows.push_back(linear.row());
}

// eq 15: the luminance wanted at x, and the drive value for it, with a black of up to a tenth.
void AddGoal(Density density, std::vector<Row>& rows) {
  WorstCase wanted("WantedLuminance", 1e-15);
  WorstCase drive("DriveForLuminance", 1e-12);
  for (Shape shape : PlainShapes(density)) {
    for (const double black : {0.0, 1e-6, 0.01, 0.1}) {
      fit::Activation& a = shape.activation;
      a.minimum_luminance = black;
      const Digits50 white = Digits50(black) + 1;
      for (const double x : LogSteps(1e-9, 1, 30 * density.steps)) {
        const Digits50 luminance = std::max<Digits50>(white * x, black);
        const double rounded = fit::WantedLuminance(a, x);
        wanted.Compare(rounded, luminance, {{"w", black}, {"x", x}});
        if (rounded <= black || rounded >= white) continue;
        const Digits50 h = Digits50(rounded) - black;
        const Digits50 exact = Inverse50(shape.exact, h);
        drive.Compare(fit::DriveForLuminance(a, rounded), exact,
                      {{"w", black}, {"gamma", a.gamma}, {"v0", a.cutoff_drive}, {"x", x}});
      }
    }
  }
  rows.push_back(wanted.row());
  rows.push_back(drive.row());
}

}  // namespace

void AddTableRows(Density density, std::vector<Row>& rows) {
  AddAxis(density, rows);
  AddSampling(density, rows);
  AddGoal(density, rows);
}

}  // namespace eyebox::numerics
