#include "service/planner/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/parallel.h"
#include "capture/base/status.h"
#include "service/planner/design_levels.h"
#include "service/planner/measure_setting.h"

namespace eyebox::service {
namespace {

constexpr double kPilotShare = 0.05;  // of the progress
constexpr double kNormal95 = 1.96;

// What one trial says about one line.
struct Trial {
  double mean_square = 0;
  double departure_mean_square = 0;
  double share_within = 0;
  double compute_s = 0;
};

double MeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

absl::StatusOr<Trial> Try(FrameSource& source, const TradeoffLine& line, const Clock& clock) {
  const Need& need = line.what.need;
  const std::vector<size_t> region =
      RegionPixels(source.Size(), source.Geometry(), need.radius_deg);
  EYEBOX_ASSIGN_OR_RETURN(const Truth truth, source.TruthFor(need.disk_deg));
  EYEBOX_ASSIGN_OR_RETURN(const Measured measured,
                          MeasureSetting(source, line.what.setting, need, region, clock));
  const std::vector<double> errors = ErrorsOf(measured, truth, need, region);
  Trial trial;
  // The truth's own noise is no error of the measurement.
  const double bound =
      std::hypot(line.predicted.bound_95, kNormal95 * std::sqrt(truth.white_relative_variance));
  for (const double error : errors) trial.share_within += std::abs(error) <= bound ? 1 : 0;
  trial.mean_square = MeanSquare(errors) - truth.white_relative_variance;
  trial.share_within /= static_cast<double>(errors.size());
  trial.departure_mean_square = MeanSquare(DeparturesOf(measured.fits[0].activation, truth, need));
  trial.compute_s = measured.seconds.Sum();
  return trial;
}

void Summarise(const std::vector<Trial>& trials, TradeoffLine& line) {
  const auto count = static_cast<double>(trials.size());
  double sum = 0;
  double squares = 0;
  double departure = 0;
  for (const Trial& trial : trials) {
    sum += trial.mean_square;
    squares += trial.mean_square * trial.mean_square;
    departure += trial.departure_mean_square;
    line.share_within_bound += trial.share_within / count;
    line.compute_s += trial.compute_s / count;
  }
  const double mean = std::max(sum / count, 0.0);
  line.rms = std::sqrt(mean);
  line.departure_rms = std::sqrt(departure / count);
  if (trials.size() < 2) return;
  const double variance = std::max(squares / count - mean * mean, 0.0) / (count - 1);
  line.rms_sigma = line.rms > 0 ? std::sqrt(variance) / (2 * line.rms) : std::pow(variance, 0.25);
}

// One trial of every line.
absl::StatusOr<std::vector<Trial>> TryAll(FrameSource& source,
                                          const std::vector<TradeoffLine>& lines,
                                          const Clock& clock,
                                          const std::function<absl::Status()>& after_each) {
  std::vector<Trial> trials;
  for (const TradeoffLine& line : lines) {
    const absl::StatusOr<Trial> trial = Try(source, line, clock);
    if (!trial.ok()) {
      return absl::Status(trial.status().code(), absl::StrCat("setting \"", line.what.setting.name,
                                                              "\": ", trial.status().message()));
    }
    trials.push_back(*trial);
    EYEBOX_RETURN_IF_ERROR(after_each());
  }
  return trials;
}

absl::Status MeasureLines(const SourceOfTrial& sources, const TradeoffOptions& options,
                          const Clock& clock, const Watcher& watcher,
                          std::vector<TradeoffLine>& lines) {
  std::mutex mutex;
  size_t done = 0;
  const double all = static_cast<double>(lines.size()) * options.trials;
  const auto after_each = [&] {
    const std::lock_guard lock(mutex);
    return watcher.Reach(kPilotShare + (1 - kPilotShare) * static_cast<double>(++done) / all,
                         absl::StrFormat("%d trials of %d settings", options.trials, lines.size()));
  };
  std::vector<absl::StatusOr<std::vector<Trial>>> trials(static_cast<size_t>(options.trials));
  ForEachInParallel(options.trials, [&](int t) {
    const std::unique_ptr<FrameSource> source = sources(t + 1);
    trials[static_cast<size_t>(t)] = TryAll(*source, lines, clock, after_each);
  });
  for (const auto& trial : trials) EYEBOX_RETURN_IF_ERROR(trial.status());
  for (size_t i = 0; i < lines.size(); ++i) {
    std::vector<Trial> of_line;
    for (const auto& trial : trials) of_line.push_back((*trial)[i]);
    Summarise(of_line, lines[i]);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<TradeoffLine>> PredictLines(const Pilot& pilot,
                                                       std::vector<TradeoffCase> cases,
                                                       const Costs& costs) {
  std::vector<Predictor> predictors;
  std::vector<TradeoffLine> lines;
  for (TradeoffCase& what : cases) {
    auto predictor = std::ranges::find_if(
        predictors, [&](const Predictor& known) { return known.need() == what.need; });
    if (predictor == predictors.end()) {
      EYEBOX_ASSIGN_OR_RETURN(Predictor made, Predictor::Make(pilot, what.need, costs));
      predictors.push_back(std::move(made));
      predictor = std::prev(predictors.end());
    }
    const absl::StatusOr<Prediction> prediction = predictor->Predict(what.setting);
    if (!prediction.ok()) {
      return absl::Status(
          prediction.status().code(),
          absl::StrCat("setting \"", what.setting.name, "\": ", prediction.status().message()));
    }
    lines.push_back({std::move(what), *prediction});
  }
  return lines;
}

void MarkFront(std::vector<TradeoffLine>& lines) {
  for (TradeoffLine& line : lines) {
    line.on_front = std::ranges::none_of(lines, [&](const TradeoffLine& other) {
      return other.what.need == line.what.need &&
             other.predicted.capture_s <= line.predicted.capture_s && other.rms < line.rms &&
             &other != &line;
    });
  }
}

double MedianDisagreement(const std::vector<TradeoffLine>& lines) {
  std::vector<double> off;
  for (const TradeoffLine& line : lines) {
    off.push_back(line.rms > 0 ? std::abs(line.predicted.rms / line.rms - 1)
                               : std::numeric_limits<double>::infinity());
  }
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle;
}

bool IsEven(const TradeoffLine& line) {
  return line.what.lever == "baseline" || line.what.lever == "frames per level";
}

// Cases that the source can give, and the others told in `left_out`.
std::vector<TradeoffCase> Within(const Stock* limits, std::vector<TradeoffCase> cases,
                                 std::vector<std::string>& left_out) {
  if (limits == nullptr) return cases;
  std::vector<TradeoffCase> within;
  for (TradeoffCase& what : cases) {
    const std::string why = WhyBeyond(*limits, what.setting, what.need);
    if (why.empty()) {
      within.push_back(std::move(what));
    } else {
      left_out.push_back(absl::StrCat(what.lever, ", ", what.setting.name, ": ", why));
    }
  }
  return within;
}

}  // namespace

absl::StatusOr<Tradeoff> MeasureTradeoff(const SourceOfTrial& sources,
                                         const TradeoffOptions& options, const Clock& clock,
                                         const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "pilot"));
  Tradeoff tradeoff;
  const std::unique_ptr<FrameSource> source = sources(0);
  const Stock* const limits = source->Limits();
  EYEBOX_ASSIGN_OR_RETURN(tradeoff.pilot, MeasurePilot(*source, clock, PilotWithin(limits)));
  EYEBOX_ASSIGN_OR_RETURN(auto cases,
                          UsualCases(tradeoff.pilot, options.costs, limits, tradeoff.left_out));
  cases = Within(limits, std::move(cases), tradeoff.left_out);
  if (cases.empty() || cases[0].lever != "baseline") {
    return Rejected(
        "tradeoff",
        "the recording cannot give even the usual measurement: " + tradeoff.left_out.front(),
        "record evenly spaced levels with several frames each");
  }
  EYEBOX_ASSIGN_OR_RETURN(tradeoff.lines,
                          PredictLines(tradeoff.pilot, std::move(cases), options.costs));
  EYEBOX_RETURN_IF_ERROR(MeasureLines(sources, options, clock, watcher, tradeoff.lines));
  MarkFront(tradeoff.lines);
  tradeoff.median_disagreement = MedianDisagreement(tradeoff.lines);
  return tradeoff;
}

std::vector<DesignSaving> SavingsByDesign(const Tradeoff& tradeoff, const Costs& costs) {
  const auto seconds_of = [&](const TradeoffLine& line) {
    return LevelSeconds(line.what.setting.levels, tradeoff.pilot.exposures_s, costs);
  };
  std::map<double, double> even;  // log departure by log seconds
  for (const TradeoffLine& line : tradeoff.lines) {
    if (IsEven(line)) even[std::log(seconds_of(line))] = std::log(line.departure_rms);
  }
  std::vector<DesignSaving> savings;
  for (const TradeoffLine& line : tradeoff.lines) {
    if (line.what.lever != "designed levels") continue;
    const double wanted = std::log(line.departure_rms);
    for (auto next = std::next(even.begin()); next != even.end(); ++next) {
      const auto [log_s, log_rms] = *std::prev(next);
      if (!(log_rms >= wanted && wanted > next->second)) continue;
      const double t = (wanted - log_rms) / (next->second - log_rms);
      savings.push_back(
          {seconds_of(line), std::exp(log_s + t * (next->first - log_s)), line.departure_rms});
      break;
    }
  }
  return savings;
}

}  // namespace eyebox::service
