// Displays whose truth is known, and what a colorimeter with noise would read of them.
#ifndef EYEBOX_TESTS_FIT_COLOR_SYNTHETIC_DISPLAY_H_
#define EYEBOX_TESTS_FIT_COLOR_SYNTHETIC_DISPLAY_H_

#include <random>
#include <vector>

#include "fit/color/colour_model.h"
#include "fit/color/colour_series.h"

namespace eyebox::fit {

// An LCD with sRGB-like primaries and a black of 0.2 % of its white of about 120 cd/m2.
inline ColourModel SyntheticDisplay(ColourModelKind kind, std::vector<double> interaction) {
  ColourModel model;
  model.kind = kind;
  model.cutoff_drive = {0.02, 0.04, 0.06};
  model.gamma = {2.1, 2.3, 2.5};
  model.background = {0.22, 0.24, 0.27};
  model.primaries = {{{49.5, 25.5, 2.3}, {42.9, 85.8, 14.3}, {21.6, 8.7, 114.0}}};
  model.interaction = std::move(interaction);
  return model;
}

// Black, then grey and each channel alone at `levels` levels up to 1.
inline std::vector<Rgb> GreysAndPrimaries(int levels) {
  std::vector<Rgb> drives = {{0, 0, 0}};
  for (int i = 1; i <= levels; ++i) {
    const double v = static_cast<double>(i) / levels;
    drives.insert(drives.end(), {{v, 0, 0}, {0, v, 0}, {0, 0, v}, {v, v, v}});
  }
  return drives;
}

// Each component times 1 + `noise` times a normal deviate.
inline ColourSeries Measure(const ColourModel& model, const std::vector<Rgb>& drives, double noise,
                            unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  ColourSeries series{{}, "synthetic"};
  for (const Rgb& drive : drives) {
    Xyz colour = model.Colour(drive);
    for (double& component : colour) component *= 1 + noise * normal(generator);
    series.readings.push_back({drive, colour});
  }
  return series;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_TESTS_FIT_COLOR_SYNTHETIC_DISPLAY_H_
