#include "fit/renderer/compare_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::fit {
namespace {

constexpr double kLevels = 255;
constexpr double kLeastScale = 0.78;
constexpr double kScaleStep = 0.001;
constexpr int kScaleSteps = 101;
constexpr double kFloorStep = 0.00005;
constexpr int kFloorSteps = 31;
constexpr double kDitherStep = 0.02;
constexpr int kDitherSteps = 15;  // to either side of 0

using Candidate = std::array<double, 3>;  // light_scale, reflectance_floor, dither_mean_levels

std::vector<Candidate> Candidates(const Hypothesis& hypothesis) {
  std::vector<double> scales = {hypothesis.model.light_scale};
  std::vector<double> floors = {hypothesis.model.reflectance_floor};
  if (hypothesis.fits_scale) {
    scales.clear();
    for (int i = 0; i < kScaleSteps; ++i) scales.push_back(kLeastScale + kScaleStep * i);
  }
  if (hypothesis.fits_floor) {
    floors.clear();
    for (int i = 0; i < kFloorSteps; ++i) floors.push_back(kFloorStep * i);
  }
  std::vector<double> dithers = {hypothesis.model.dither_mean_levels};
  if (hypothesis.fits_dither) {
    dithers.clear();
    for (int i = -kDitherSteps; i <= kDitherSteps; ++i) dithers.push_back(kDitherStep * i);
  }
  std::vector<Candidate> candidates;
  for (const double scale : scales) {
    for (const double floor : floors) {
      for (const double dither : dithers) candidates.push_back({scale, floor, dither});
    }
  }
  return candidates;
}

// What every candidate predicts for every row, made once; fits and folds only add it up.
struct Table {
  std::vector<Candidate> candidates;
  std::vector<std::vector<std::vector<optics::Rgb>>> predicted;  // [candidate][set][row]
  std::vector<std::vector<std::vector<double>>> loss;            // [candidate][set][row]
};

double LossOf(const optics::Rgb& predicted, const optics::Rgb& stored, double limit) {
  double loss = 0;
  for (size_t channel = 0; channel < 3; ++channel) {
    loss += std::min(kLevels * std::abs(predicted[channel] - stored[channel]), limit) / 3;
  }
  return loss;
}

absl::StatusOr<Table> Tabulate(const std::vector<RenderedSet>& sets, const Hypothesis& hypothesis,
                               double limit) {
  Table table;
  table.candidates = Candidates(hypothesis);
  table.predicted.resize(table.candidates.size());
  table.loss.resize(table.candidates.size());
  for (const RenderedSet& set : sets) {
    const optics::ColourTable* cube = set.cube ? &*set.cube : nullptr;
    EYEBOX_ASSIGN_OR_RETURN(HdrpRenderer renderer, HdrpRenderer::Create(hypothesis.model, cube));
    for (size_t c = 0; c < table.candidates.size(); ++c) {
      const Candidate& candidate = table.candidates[c];
      renderer.SetParameters(candidate[0], candidate[1], candidate[2]);
      std::vector<optics::Rgb>& predicted = table.predicted[c].emplace_back();
      std::vector<double>& loss = table.loss[c].emplace_back();
      for (const SceneRow& row : set.rows) {
        predicted.push_back(renderer.Predict(row, set.material).stored);
        loss.push_back(LossOf(predicted.back(), *row.stored, limit));
      }
    }
  }
  return table;
}

// The candidate with the smallest mean over sets of the weighted mean loss over their rows; of
// equals the middle one. weights[set][row].
size_t BestCandidate(const Table& table, const std::vector<std::vector<double>>& weights) {
  std::vector<double> losses(table.candidates.size(), 0);
  for (size_t c = 0; c < losses.size(); ++c) {
    for (size_t set = 0; set < weights.size(); ++set) {
      double sum = 0;
      double weight = 0;
      for (size_t row = 0; row < weights[set].size(); ++row) {
        sum += weights[set][row] * table.loss[c][set][row];
        weight += weights[set][row];
      }
      if (weight > 0) losses[c] += sum / weight;
    }
  }
  const double least = *std::min_element(losses.begin(), losses.end());
  std::vector<size_t> equals;
  for (size_t c = 0; c < losses.size(); ++c) {
    if (losses[c] <= least * (1 + 1e-12)) equals.push_back(c);
  }
  return equals[equals.size() / 2];
}

template <typename Weight>
std::vector<std::vector<double>> Weights(const std::vector<RenderedSet>& sets, Weight weight) {
  std::vector<std::vector<double>> weights;
  for (const RenderedSet& set : sets) {
    std::vector<double>& of_set = weights.emplace_back();
    for (size_t row = 0; row < set.rows.size(); ++row) of_set.push_back(weight(row));
  }
  return weights;
}

// Standard deviation of the fitted values over rows drawn again with replacement.
std::vector<Parameter> Parameters(const Table& table, const std::vector<RenderedSet>& sets,
                                  const Hypothesis& hypothesis, size_t best, int samples) {
  std::mt19937 random(1);
  std::poisson_distribution<int> times(1);
  const Candidate& fitted = table.candidates[best];
  std::vector<Parameter> parameters = {{"light_scale", fitted[0], 0, "1"},
                                       {"reflectance_floor", fitted[1], 0, "1"},
                                       {"dither_mean", fitted[2], 0, "1/255"}};
  const std::array<bool, 3> fits = {hypothesis.fits_scale, hypothesis.fits_floor,
                                    hypothesis.fits_dither};
  constexpr Candidate kSteps = {kScaleStep, kFloorStep, kDitherStep};
  if (table.candidates.size() == 1) return parameters;
  Candidate variance{};
  for (int sample = 0; sample < samples; ++sample) {
    const size_t drawn = BestCandidate(table, Weights(sets, [&](size_t) { return times(random); }));
    for (size_t i = 0; i < 3; ++i) {
      variance[i] += std::pow(table.candidates[drawn][i] - fitted[i], 2) / samples;
    }
  }
  for (size_t i = 0; i < 3; ++i) {
    if (fits[i]) parameters[i].sigma = std::sqrt(variance[i] + kSteps[i] * kSteps[i] / 12);
  }
  return parameters;
}

absl::StatusOr<ComparedModel> Compare(const std::vector<RenderedSet>& sets,
                                      const Hypothesis& hypothesis,
                                      const ComparisonOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const Table table, Tabulate(sets, hypothesis, options.loss_limit));
  const auto folds = static_cast<size_t>(options.folds);
  const size_t best = BestCandidate(table, Weights(sets, [](size_t) { return 1.0; }));
  std::vector<size_t> of_fold;
  for (size_t fold = 0; fold < folds; ++fold) {
    of_fold.push_back(BestCandidate(
        table, Weights(sets, [&](size_t row) { return row % folds == fold ? 0.0 : 1.0; })));
  }
  ComparedModel result;
  result.hypothesis = hypothesis;
  result.parameters = Parameters(table, sets, hypothesis, best, options.bootstrap_samples);
  double values = 0;
  for (size_t set = 0; set < sets.size(); ++set) {
    std::vector<optics::Rgb> held_out;
    for (size_t row = 0; row < sets[set].rows.size(); ++row) {
      held_out.push_back(table.predicted[of_fold[row % folds]][set][row]);
    }
    result.held_out.push_back(ErrorOf(sets[set], held_out));
    result.in_sample.push_back(ErrorOf(sets[set], table.predicted[best][set]));
    const SetError& error = result.held_out.back();
    result.mean_held_out += error.mean / static_cast<double>(sets.size());
    for (size_t channel = 0; channel < 3; ++channel) {
      result.bias[channel] += error.bias[channel] * error.values;
    }
    values += error.values;
  }
  for (double& bias : result.bias) bias /= values;
  return result;
}

Hypothesis Named(std::string name, HdrpModel model, bool fits_scale, bool fits_floor,
                 bool fits_dither = false) {
  return {std::move(name), model, fits_scale, fits_floor, fits_dither};
}

}  // namespace

std::vector<Hypothesis> StandardHypotheses() {
  HdrpModel model = HdrpModel::Published();
  std::vector<Hypothesis> list = {Named("published", model, false, false),
                                  Named("published, c fitted", model, true, false)};
  model.axis = TableAxis::kLogC;
  list.push_back(Named("analytic LogC table", model, true, false));
  model.half_float_table = true;
  model.buffer = ColorBuffer::kHalf;
  list.push_back(Named("+ R16G16B16A16 buffers", model, true, false));
  model.buffer = ColorBuffer::kPackedRounded;
  list.push_back(Named("+ R11G11B10 buffers, rounded", model, true, false));
  model.buffer = ColorBuffer::kPackedTruncated;
  list.push_back(Named("+ R11G11B10 buffers, truncated", model, true, false));
  list.push_back(Named("  + reflectance floor", model, true, true));
  model.grading_through_hsv = true;
  list.push_back(Named("  + grading through HSV", model, true, false));
  list.push_back(Named("  + HSV + floor", model, true, true));
  model.stores_lights_apart = true;
  list.push_back(Named("  + HSV + lights stored apart", model, true, false));
  list.push_back(Named("  + HSV + floor + lights apart", model, true, true));
  model.light_scale = HdrpModel{}.light_scale;
  list.push_back(Named("    the same, c = 1/1.2", model, false, true));
  list.push_back(Named("    the same + mean of the dither", model, false, true, true));
  list.push_back(Named("default of this program", HdrpModel{}, false, false));
  list.back().competes = false;
  return list;
}

SetError ErrorOf(const RenderedSet& set, const std::vector<optics::Rgb>& predicted) {
  SetError error{.set = set.name};
  std::vector<double> sizes;
  optics::Rgb squares{};
  const auto rows = static_cast<double>(set.rows.size());
  for (size_t row = 0; row < set.rows.size(); ++row) {
    for (size_t channel = 0; channel < 3; ++channel) {
      const double difference =
          kLevels * (predicted[row][channel] - (*set.rows[row].stored)[channel]);
      sizes.push_back(std::abs(difference));
      if (sizes.back() > error.worst) {
        error.worst = sizes.back();
        error.worst_row = static_cast<int>(row);
      }
      error.mean += sizes.back() / (3 * rows);
      error.bias[channel] += difference / rows;
      squares[channel] += difference * difference / rows;
    }
  }
  for (size_t channel = 0; channel < 3; ++channel) {
    const double variance = squares[channel] - error.bias[channel] * error.bias[channel];
    error.bias_sigma[channel] = std::sqrt(std::max(variance, 0.0) / std::max(rows - 1, 1.0));
  }
  error.values = static_cast<int>(sizes.size());
  const size_t half = sizes.size() / 2;
  std::sort(sizes.begin(), sizes.end());
  error.median = sizes.size() % 2 == 1 ? sizes[half] : (sizes[half - 1] + sizes[half]) / 2;
  return error;
}

absl::StatusOr<std::vector<ComparedModel>> CompareModels(const std::vector<RenderedSet>& sets,
                                                         const std::vector<Hypothesis>& hypotheses,
                                                         const ComparisonOptions& options) {
  if (sets.empty()) return BadInput("rows", "there is none", "give at least one set of rows");
  if (options.folds < 2 || !(options.loss_limit > 0) || options.bootstrap_samples < 2) {
    return BadInput("options", "folds, loss limit or bootstrap samples are too small",
                    "give at least 2 folds, a limit above 0 and 2 samples");
  }
  std::vector<RenderedSet> measured = sets;
  for (RenderedSet& set : measured) {
    std::erase_if(set.rows, [](const SceneRow& row) { return !row.stored; });
    if (set.rows.size() < static_cast<size_t>(options.folds)) {
      return BadInput(
          set.name,
          absl::StrFormat("%d rows with v_r, v_g and v_b", static_cast<int>(set.rows.size())),
          absl::StrFormat("give at least %d, one a fold", options.folds));
    }
  }
  std::vector<ComparedModel> compared;
  for (const Hypothesis& hypothesis : hypotheses) {
    EYEBOX_ASSIGN_OR_RETURN(ComparedModel model, Compare(measured, hypothesis, options));
    compared.push_back(std::move(model));
  }
  return compared;
}

}  // namespace eyebox::fit
