#include "fit/color/drive_for_colour.h"

#include <algorithm>
#include <cmath>

namespace eyebox::fit {
namespace {

constexpr int kMostSweeps = 100;
constexpr double kSettled = 1e-13;
// Wanted activations are called negative below this share of their sum: primaries that are those of
// the display give 0 up to rounding.
constexpr double kNegativeShare = 1e-6;

bool AnyNegative(const Rgb& activations) {
  const double sum = std::abs(activations[0]) + std::abs(activations[1]) + std::abs(activations[2]);
  return *std::ranges::min_element(activations) < -kNegativeShare * sum;
}

// The activations nearest to `wanted` that are at least `lower` and have the luminance `luminance`:
// what is missing is taken from, or given to, the free channels alike. Channels once held stay
// held, because each of them takes more from the others.
Rgb FillUp(const ColourModel& model, const Rgb& wanted, const Rgb& lower, double luminance) {
  std::array<bool, 3> held = {};
  Rgb activations = wanted;
  for (int round = 0; round < 3; ++round) {
    double missing = luminance;
    double weight = 0;
    for (size_t k = 0; k < 3; ++k) {
      missing -= model.primaries[k][1] * (held[k] ? lower[k] : wanted[k]);
      weight += held[k] ? 0 : model.primaries[k][1];
    }
    const double shift = weight > 0 ? missing / weight : 0;
    bool changed = false;
    for (size_t k = 0; k < 3; ++k) {
      if (!held[k] && wanted[k] + shift < lower[k]) held[k] = changed = true;
      activations[k] = held[k] ? lower[k] : wanted[k] + shift;
    }
    if (!changed) break;
  }
  return activations;
}

}  // namespace

ColourDrive DriveForColour(const ColourModel& model, const Xyz& wanted) {
  const Xyz above_black = Minus(wanted, model.background);
  const Rgb activations = WeightsFor(model.primaries, above_black);
  ColourDrive result;
  result.saturation_reached = !AnyNegative(activations);
  result.inside_gamut = !AnyNegative(WeightsFor(model.primaries, wanted));
  const double luminance = std::max(above_black[1], 0.0);
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    Rgb lower;
    for (size_t k = 0; k < 3; ++k) lower[k] = model.LeastActivation(k, result.drive);
    const Rgb reached = FillUp(model, activations, lower, luminance);
    double change = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double drive = std::max(model.OwnDrive(k, reached[k], result.drive), 0.0);
      change = std::max(change, std::abs(drive - result.drive[k]));
      result.drive[k] = drive;
    }
    if (change < kSettled) break;
  }
  return result;
}

Xyz NearestInGamut(const ColourModel& model, const Xyz& wanted) {
  const Rgb activations = WeightsFor(model.primaries, wanted);
  return Combine(model.primaries, FillUp(model, activations, {0, 0, 0}, wanted[1]));
}

}  // namespace eyebox::fit
