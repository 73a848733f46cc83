#include "fit/color/colour_model.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "capture/base/status.h"
#include "fit/color/colour_forward.h"

namespace eyebox::fit {
namespace {

constexpr ColourModelKind kAllKinds[] = {
    ColourModelKind::kAdditive, ColourModelKind::kCommonCrosstalk, ColourModelKind::kDriveCrosstalk,
    ColourModelKind::kActivationGain, ColourModelKind::kPairwiseCrosstalk};
constexpr char kChannels[] = {'r', 'g', 'b'};
constexpr char kComponents[] = {'x', 'y', 'z'};
// Beyond this neighbours would rule a channel, and the model could not be undone.
constexpr double kLargestInteraction = 0.5;

std::string Letter(char letter) { return std::string(1, letter); }

absl::Status OutOfRange(std::string_view where, const std::string& name, double value,
                        const char* range) {
  return BadInput(where, absl::StrCat("parameter ", name, " is ", value),
                  absl::StrCat("it must be ", range));
}

}  // namespace

std::string_view NameOf(ColourModelKind kind) {
  switch (kind) {
    case ColourModelKind::kAdditive:
      return "additive";
    case ColourModelKind::kCommonCrosstalk:
      return "common_crosstalk";
    case ColourModelKind::kDriveCrosstalk:
      return "drive_crosstalk";
    case ColourModelKind::kPairwiseCrosstalk:
      return "pairwise_crosstalk";
    case ColourModelKind::kActivationGain:
      return "activation_gain";
  }
  return "";
}

absl::StatusOr<ColourModelKind> ColourModelKindOf(std::string_view name) {
  std::string known;
  for (ColourModelKind kind : kAllKinds) {
    if (NameOf(kind) == name) return kind;
    absl::StrAppend(&known, known.empty() ? "" : ", ", std::string(NameOf(kind)));
  }
  return BadInput("model", absl::StrCat("there is no colour model '", std::string(name), "'"),
                  absl::StrCat("give one of ", known));
}

std::span<const ColourModelKind> AllColourModelKinds() { return kAllKinds; }

int InteractionCount(ColourModelKind kind) {
  switch (kind) {
    case ColourModelKind::kAdditive:
      return 0;
    case ColourModelKind::kCommonCrosstalk:
      return 1;
    case ColourModelKind::kPairwiseCrosstalk:
      return 6;
    case ColourModelKind::kDriveCrosstalk:
    case ColourModelKind::kActivationGain:
      return 3;
  }
  return 0;
}

std::vector<std::string> ParameterNames(ColourModelKind kind) {
  std::vector<std::string> names;
  for (char k : kChannels) names.push_back("cutoff_drive_" + Letter(k));
  for (char k : kChannels) names.push_back("gamma_" + Letter(k));
  for (char c : kComponents) names.push_back("background_" + Letter(c));
  for (char k : kChannels) {
    for (char c : kComponents) names.push_back("primary_" + Letter(k) + "_" + Letter(c));
  }
  if (kind == ColourModelKind::kCommonCrosstalk) names.emplace_back("crosstalk");
  for (char k : kChannels) {
    if (kind == ColourModelKind::kDriveCrosstalk) names.push_back("crosstalk_" + Letter(k));
    if (kind == ColourModelKind::kActivationGain) names.push_back("gain_" + Letter(k));
    for (char j : kChannels) {
      if (kind != ColourModelKind::kPairwiseCrosstalk || j == k) continue;
      names.push_back("crosstalk_" + Letter(k) + "_from_" + Letter(j));
    }
  }
  return names;
}

ColourModel ColourModel::FromParameters(ColourModelKind kind, std::span<const double> parameters) {
  ColourModel model;
  model.kind = kind;
  for (size_t k = 0; k < 3; ++k) {
    model.cutoff_drive[k] = parameters[kCutoff + k];
    model.gamma[k] = parameters[kGamma + k];
    model.background[k] = parameters[kBackground + k];
    for (size_t c = 0; c < 3; ++c) model.primaries[k][c] = parameters[kPrimaries + 3 * k + c];
  }
  const auto interaction = parameters.subspan(kInteraction);
  model.interaction.assign(interaction.begin(), interaction.end());
  return model;
}

std::vector<double> ColourModel::ToParameters() const {
  std::vector<double> parameters(cutoff_drive.begin(), cutoff_drive.end());
  parameters.insert(parameters.end(), gamma.begin(), gamma.end());
  parameters.insert(parameters.end(), background.begin(), background.end());
  for (const Xyz& primary : primaries) {
    parameters.insert(parameters.end(), primary.begin(), primary.end());
  }
  parameters.insert(parameters.end(), interaction.begin(), interaction.end());
  return parameters;
}

absl::Status ColourModel::Validate(std::string_view where) const {
  const std::vector<std::string> names = ParameterNames(kind);
  const std::vector<double> values = ToParameters();
  if (values.size() != names.size()) {
    return BadInput(where,
                    absl::StrCat(std::string(NameOf(kind)), " has ", names.size(),
                                 " parameters, not ", values.size()),
                    "fit again");
  }
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return OutOfRange(where, names[i], values[i], "finite");
    if (i < kGamma && !(values[i] >= 0 && values[i] < 1)) {
      return OutOfRange(where, names[i], values[i], "at least 0 and below 1");
    }
    if (i >= kGamma && i < kBackground && !(values[i] > 0)) {
      return OutOfRange(where, names[i], values[i], "above 0");
    }
    if (i >= kInteraction && !(std::abs(values[i]) < kLargestInteraction)) {
      return OutOfRange(where, names[i], values[i], "between -0.5 and 0.5");
    }
  }
  for (size_t k = 0; k < 3; ++k) {
    if (primaries[k][1] > 0) continue;
    return OutOfRange(where, names[kPrimaries + 3 * k + 1], primaries[k][1], "above 0");
  }
  const Rgb weights = WeightsFor(primaries, primaries[0]);
  if (!std::ranges::all_of(weights, [](double weight) { return std::isfinite(weight); })) {
    return BadInput(where, "the three primaries lie on one line of the chromaticity diagram",
                    "check that each channel was measured by itself");
  }
  return absl::OkStatus();
}

Matrix3 ColourModel::Interaction() const { return ExpandInteraction(kind, interaction.data()); }

Rgb ColourModel::Activations(const Rgb& drive) const {
  const std::vector<double> parameters = ToParameters();
  return ForwardActivations(kind, parameters.data(), drive);
}

double ColourModel::OwnDrive(size_t channel, double activation, const Rgb& drive) const {
  const bool is_gain = kind == ColourModelKind::kActivationGain;
  const Matrix3 c = Interaction();
  double gain = 1;
  for (size_t j = 0; j < 3 && is_gain; ++j) {
    gain += c[channel][j] * ChannelActivation(cutoff_drive[j], gamma[j], drive[j]);
  }
  const double base = activation > 0 ? std::pow(activation / gain, 1 / gamma[channel]) : 0;
  return cutoff_drive[channel] + (1 - cutoff_drive[channel]) * base - Lift(channel, drive);
}

double ColourModel::LeastActivation(size_t channel, const Rgb& drive) const {
  return ChannelActivation(cutoff_drive[channel], gamma[channel], Lift(channel, drive));
}

double ColourModel::Lift(size_t channel, const Rgb& drive) const {
  if (kind == ColourModelKind::kActivationGain) return 0;
  const Matrix3 c = Interaction();
  return c[channel][0] * drive[0] + c[channel][1] * drive[1] + c[channel][2] * drive[2];
}

}  // namespace eyebox::fit
