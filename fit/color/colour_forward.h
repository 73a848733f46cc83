// The colour model as one template, so that Ceres differentiates what everyone else evaluates.
#ifndef EYEBOX_FIT_COLOR_COLOUR_FORWARD_H_
#define EYEBOX_FIT_COLOR_COLOUR_FORWARD_H_

#include <array>
#include <cmath>

#include "fit/color/colour_model.h"

namespace eyebox::fit {

// The parameters of a ColourModel in the order of ParameterNames.
enum ColourParameter {
  kCutoff = 0,
  kGamma = 3,
  kBackground = 6,
  kPrimaries = 9,
  kInteraction = 18
};

// max((w - v0) / (1 - v0), 0)^gamma. At and below v0 value and derivatives are exactly 0: the limit
// 0 log 0 of the one by gamma included.
template <typename T>
T ChannelActivation(const T& cutoff, const T& gamma, const T& effective_drive) {
  using std::pow;
  const T base = (effective_drive - cutoff) / (T(1) - cutoff);
  if (!(base > T(0))) return T(0);
  return pow(base, gamma);
}

// c_kj of the free parameters of `kind`; diagonal 0.
template <typename T>
std::array<std::array<T, 3>, 3> ExpandInteraction(ColourModelKind kind, const T* free) {
  std::array<std::array<T, 3>, 3> matrix;
  int pair = 0;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      matrix[k][j] = T(0);
      if (j == k || kind == ColourModelKind::kAdditive) continue;
      if (kind == ColourModelKind::kCommonCrosstalk) matrix[k][j] = free[0] / T(2);
      if (kind == ColourModelKind::kPairwiseCrosstalk) matrix[k][j] = free[pair];
      if (kind == ColourModelKind::kDriveCrosstalk || kind == ColourModelKind::kActivationGain) {
        matrix[k][j] = free[k] / T(2);
      }
      ++pair;
    }
  }
  return matrix;
}

template <typename T>
std::array<T, 3> ForwardActivations(ColourModelKind kind, const T* parameters, const Rgb& drive) {
  const auto c = ExpandInteraction(kind, parameters + kInteraction);
  const bool gain = kind == ColourModelKind::kActivationGain;
  std::array<T, 3> alone;
  for (int k = 0; k < 3; ++k) {
    T effective(drive[k]);
    for (int j = 0; j < 3 && !gain; ++j) effective += c[k][j] * T(drive[j]);
    alone[k] = ChannelActivation(parameters[kCutoff + k], parameters[kGamma + k], effective);
  }
  if (!gain) return alone;
  std::array<T, 3> raised = alone;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) raised[k] += alone[k] * c[k][j] * alone[j];
  }
  return raised;
}

// x, [3].
template <typename T>
std::array<T, 3> ForwardColour(ColourModelKind kind, const T* parameters, const Rgb& drive) {
  const std::array<T, 3> activations = ForwardActivations(kind, parameters, drive);
  std::array<T, 3> colour;
  for (int c = 0; c < 3; ++c) {
    colour[c] = parameters[kBackground + c];
    for (int k = 0; k < 3; ++k) colour[c] += activations[k] * parameters[kPrimaries + 3 * k + c];
  }
  return colour;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_FORWARD_H_
