// The colour that a display shows for three drive values.
#ifndef EYEBOX_FIT_COLOR_COLOUR_MODEL_H_
#define EYEBOX_FIT_COLOR_COLOUR_MODEL_H_

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "fit/color/tristimulus.h"

namespace eyebox::fit {

// x = z + sum_k a_k p_k (HDRP model, eq 19), with a_k the activation of channel k:
//   additive       a_k = h_k(v_k)
//   crosstalk      a_k = h_k(v_k + sum_j c_kj v_j): neighbours raise the effective drive value
//   gain           a_k = h_k(v_k) (1 + sum_j c_kj h_j(v_j)): neighbours raise the gain; below 0 a
//                  display that dims when it shows much light
// and h_k(w) = max((w - v0_k) / (1 - v0_k), 0)^gamma_k, continued beyond w = 1.
enum class ColourModelKind {
  kAdditive,           // no interaction
  kCommonCrosstalk,    // c_kj = c / 2: 1 parameter
  kDriveCrosstalk,     // c_kj = c_k / 2: 3 parameters, which greys and primaries determine
  kPairwiseCrosstalk,  // c_kj free: 6 parameters, which need mixtures of two channels
  kActivationGain,     // c_kj = c_k / 2: 3 parameters
};
std::string_view NameOf(ColourModelKind kind);  // "additive", "common_crosstalk", ...
// Errors: InvalidArgument listing the names.
absl::StatusOr<ColourModelKind> ColourModelKindOf(std::string_view name);
// The order in which they are tried: by number of parameters.
std::span<const ColourModelKind> AllColourModelKinds();

constexpr int kAdditiveParameters = 18;
int InteractionCount(ColourModelKind kind);
inline int ParameterCount(ColourModelKind kind) {
  return kAdditiveParameters + InteractionCount(kind);
}
// "cutoff_drive_r", .., "gamma_r", .., "background_x", .., "primary_r_x", .., then those of the
// interaction: "crosstalk", "crosstalk_r", "crosstalk_r_from_g" or "gain_r". [ParameterCount]
std::vector<std::string> ParameterNames(ColourModelKind kind);

struct ColourModel {
  ColourModelKind kind = ColourModelKind::kAdditive;
  Rgb cutoff_drive = {0, 0, 0};  // v0_k
  Rgb gamma = {2.2, 2.2, 2.2};
  Xyz background = {0, 0, 0};         // z
  std::array<Xyz, 3> primaries = {};  // p_k: each channel alone at full drive, above z
  std::vector<double> interaction;    // [InteractionCount(kind)], 1

  // From and to the order of ParameterNames; `parameters` has ParameterCount(kind) of them.
  static ColourModel FromParameters(ColourModelKind kind, std::span<const double> parameters);
  std::vector<double> ToParameters() const;

  // Errors: InvalidArgument naming `where` and the parameter that is out of range: v0 in [0, 1),
  // gamma > 0, all finite, primaries independent with Y > 0, interaction within (-0.5, 0.5).
  absl::Status Validate(std::string_view where) const;

  // c_kj, 0 on the diagonal.
  Matrix3 Interaction() const;
  // a_k at drive values in [0, 1], or a little above 1 for entries beyond white.
  Rgb Activations(const Rgb& drive) const;
  // x.
  Xyz Colour(const Rgb& drive) const {
    return Plus(background, Combine(primaries, Activations(drive)));
  }
  // The drive value of `channel` at which its activation is `activation` >= 0, while the others
  // stay at `drive`; at and below 0 the largest such drive value, so that it is continuous. Not cut
  // to [0, 1].
  double OwnDrive(size_t channel, double activation, const Rgb& drive) const;
  // Its activation at its own drive value 0: above 0 where neighbours lift it over its cutoff.
  double LeastActivation(size_t channel, const Rgb& drive) const;

 private:
  // What the neighbours add to the effective drive value.
  double Lift(size_t channel, const Rgb& drive) const;
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_COLOR_COLOUR_MODEL_H_
