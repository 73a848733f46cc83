// What each lever of a measurement costs and what error it leaves: predicted from a pilot, and
// measured against the truth.
#ifndef EYEBOX_SERVICE_PLANNER_TRADEOFF_H_
#define EYEBOX_SERVICE_PLANNER_TRADEOFF_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "service/planner/frame_source.h"
#include "service/planner/predict_error.h"
#include "service/planner/setting.h"
#include "service/watcher.h"

namespace eyebox::service {

// One line of the table. `lever`: what differs from the line "baseline".
struct TradeoffCase {
  std::string lever;
  Setting setting;  // its name says how
  Need need;
};

// Every lever by itself about a usual measurement, some of them together, and levels by design
// beside evenly spaced ones of the same time. Where `limits` are given, a usual measurement within
// them, and designed levels moved to the nearest there are. A design for which the time is too
// short goes to `left_out`, with the reason. Errors: those of DesignLevels.
absl::StatusOr<std::vector<TradeoffCase>> UsualCases(const Pilot& pilot, const Costs& costs,
                                                     const Stock* limits,
                                                     std::vector<std::string>& left_out);

// Why a source with `limits` cannot give a setting; empty where it can.
std::string WhyBeyond(const Stock& limits, const Setting& setting, const Need& need);

struct TradeoffLine {
  TradeoffCase what;
  Prediction predicted;
  double rms = 0;                 // measured, over places, levels and trials
  double rms_sigma = 0;           // standard uncertainty, from the spread of the trials
  double departure_rms = 0;       // measured, see DeparturesOf
  double share_within_bound = 0;  // of errors, of the predicted 95 %
  double compute_s = 0;           // mean of a trial, all steps
  bool on_front = false;          // nothing is both quicker and better for the same need
  double Seconds() const { return predicted.capture_s + compute_s; }
};

struct Tradeoff {
  Pilot pilot;
  std::vector<TradeoffLine> lines;
  double median_disagreement = 0;     // of |predicted / measured rms - 1|
  std::vector<std::string> left_out;  // settings that the source cannot give, and why
};

// A source for each trial, 0 that of the pilot; each with a sensor and noise of its own.
using SourceOfTrial = std::function<std::unique_ptr<FrameSource>(int trial)>;

struct TradeoffOptions {
  int trials = 24;
  Costs costs;
};

// Trials run on all processors. Errors: those of MeasurePilot, Predict, MeasureSetting; Cancelled.
absl::StatusOr<Tradeoff> MeasureTradeoff(const SourceOfTrial& sources,
                                         const TradeoffOptions& options, const Clock& clock,
                                         const Watcher& watcher);

// How much time levels by design save over evenly spaced ones at equal error, from the lines of
// UsualCases: the time that evenly spaced levels need for the departure that the design leaves,
// over the design's, interpolated in log time; one for each designed line that lies within.
struct DesignSaving {
  double design_s = 0;  // capture of the levels alone
  double even_s = 0;
  double departure_rms = 0;
  double Factor() const { return even_s / design_s; }
};
std::vector<DesignSaving> SavingsByDesign(const Tradeoff& tradeoff, const Costs& costs);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_TRADEOFF_H_
