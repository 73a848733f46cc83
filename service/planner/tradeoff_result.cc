#include "service/planner/tradeoff_result.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/planner/explain_plan.h"
#include "service/planner/recording_measurement.h"
#include "service/planner/simulated_measurement.h"
#include "service/report/front_figure.h"
#include "service/result_json.h"
#include "service/results/parameter.h"

namespace eyebox::service {
namespace {

constexpr double kPercent = 100;

void Describe(const TradeoffLine& from, v1::TradeoffLine& line) {
  const Setting& setting = from.what.setting;
  line.set_lever(from.what.lever);
  line.set_setting(setting.name);
  line.set_levels(static_cast<int>(setting.levels.size()));
  line.set_frames(FrameCount(setting));
  line.set_model(std::string(fit::NameOf(setting.model)));
  line.set_field(std::string(NameOf(setting.tier)));
  line.set_field_size(setting.tier == FieldTier::kNone ? 0 : setting.tier_size);
  line.set_table_size(setting.table_size);
  line.set_radius_deg(from.what.need.radius_deg);
  line.set_disk_deg(from.what.need.disk_deg);
  line.set_capture_s(from.predicted.capture_s);
  line.set_compute_s(from.compute_s);
  line.set_predicted_rms(from.predicted.rms);
  line.set_predicted_bound_95(from.predicted.bound_95);
  v1::Parameter& rms = *line.mutable_measured_rms();
  rms.set_name("rms");
  rms.set_value(from.rms);
  rms.set_sigma(from.rms_sigma);
  rms.set_unit("1");
  line.set_share_within_bound(from.share_within_bound);
  line.set_predicted_departure_rms(from.predicted.departure_rms);
  line.set_measured_departure_rms(from.departure_rms);
  line.set_on_front(from.on_front);
  Describe(from.predicted, *line.mutable_parts());
}

// Beside the first line, which is the baseline. Of predicted errors, which have no noise.
void AddPrices(v1::TradeoffResult& result) {
  const v1::TradeoffLine& baseline = result.lines(0);
  for (v1::TradeoffLine& line : *result.mutable_lines()) {
    const double seconds = line.capture_s() - baseline.capture_s();
    const double percent = kPercent * (baseline.predicted_rms() - line.predicted_rms());
    if (seconds * percent > 0) line.set_price_s_per_percent(seconds / percent);
  }
}

std::string DrawLines(const v1::TradeoffResult& result) {
  std::vector<report::FrontPoint> points;
  const v1::TradeoffLine& baseline = result.lines(0);
  for (const v1::TradeoffLine& line : result.lines()) {
    // Other scenes ask for less; their points would stand for something else.
    const bool same_scene =
        line.radius_deg() == baseline.radius_deg() && line.disk_deg() == baseline.disk_deg();
    if (!same_scene) continue;
    points.push_back({line.capture_s(), kPercent * line.measured_rms().value(),
                      kPercent * line.measured_rms().sigma(), kPercent * line.predicted_rms(),
                      line.on_front(), line.lever() + ": " + line.setting()});
  }
  return report::DrawFrontAlone(points);
}

absl::Status WriteFiles(const std::filesystem::path& folder, v1::TradeoffResult& result) {
  for (const char* const name : {"tradeoff.json", "tradeoff.csv", "tradeoff.svg"}) {
    result.add_files(name);
  }
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(folder / "tradeoff.csv", ToCsv(result)));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(folder / "tradeoff.svg", DrawLines(result)));
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  return WriteFileAtomically(folder / "tradeoff.json", json);
}

absl::StatusOr<SourceOfTrial> SimulatedSources(const capture::RigConfig& rig) {
  constexpr std::string_view kScheme = "sim:";
  if (!rig.camera_uri.starts_with(kScheme)) {
    return BadInput(rig.camera_uri, "the truth of a rig that is not simulated is not known",
                    "give a simulated rig, such as sim:rift-s-like, or a recording of your rig");
  }
  EYEBOX_ASSIGN_OR_RETURN(const capture::SimParameters parameters,
                          capture::NamedSimParameters(rig.camera_uri.substr(kScheme.size())));
  return [parameters, seed = rig.seed](int trial) {
    return std::make_unique<SimulatedMeasurement>(parameters, seed + static_cast<uint64_t>(trial));
  };
}

absl::StatusOr<SourceOfTrial> RecordedSources(const std::filesystem::path& recording) {
  EYEBOX_ASSIGN_OR_RETURN(const auto frames, RecordedFrames::Read(recording));
  return [frames](int trial) {
    return std::make_unique<RecordingMeasurement>(frames, static_cast<uint64_t>(trial));
  };
}

}  // namespace

v1::TradeoffResult ToProto(const Tradeoff& tradeoff, const TradeoffOptions& options,
                           const std::string& source) {
  v1::TradeoffResult result;
  const fit::Activation& display = tradeoff.pilot.activation.activation;
  AddParameter(*result.mutable_parameters(), "gamma", display.gamma,
               tradeoff.pilot.activation.parameters[3].sigma, "1");
  AddParameter(*result.mutable_parameters(), "white_luminance", display.Luminance(1),
               fit::LuminanceSigma(tradeoff.pilot.activation, 1), "cd/m2");
  AddParameter(*result.mutable_parameters(), "system_gain", tradeoff.pilot.noise.gain_dn_per_e,
               tradeoff.pilot.noise.gain_sigma_dn_per_e, "DN/e");
  for (const TradeoffLine& line : tradeoff.lines) Describe(line, *result.add_lines());
  AddPrices(result);
  result.set_median_disagreement(tradeoff.median_disagreement);
  result.set_trials(options.trials);
  result.set_source(source);
  for (const std::string& what : tradeoff.left_out) result.add_warnings("left out: " + what);
  for (const DesignSaving& saving : SavingsByDesign(tradeoff, options.costs)) {
    v1::DesignSaving& line = *result.add_savings();
    line.set_design_s(saving.design_s);
    line.set_even_s(saving.even_s);
    line.set_departure_rms(saving.departure_rms);
    line.set_factor(saving.Factor());
  }
  return result;
}

std::string ToCsv(const v1::TradeoffResult& result) {
  std::string csv =
      "lever,setting,levels,frames,model,field,field_size,table_size,radius_deg,disk_deg,capture_s,"
      "compute_s,predicted_rms,measured_rms,measured_rms_sigma,predicted_bound_95,"
      "share_within_bound,predicted_departure_rms,measured_departure_rms,on_front,"
      "price_s_per_percent\n";
  for (const v1::TradeoffLine& line : result.lines()) {
    absl::StrAppendFormat(
        &csv, "%s,\"%s\",%d,%d,%s,%s,%d,%d,%g,%g,%.4g,%.4g,%.5g,%.5g,%.2g,%.5g,%.4f,%.5g,%.5g,%d,",
        line.lever(), line.setting(), line.levels(), line.frames(), line.model(), line.field(),
        line.field_size(), line.table_size(), line.radius_deg(), line.disk_deg(), line.capture_s(),
        line.compute_s(), line.predicted_rms(), line.measured_rms().value(),
        line.measured_rms().sigma(), line.predicted_bound_95(), line.share_within_bound(),
        line.predicted_departure_rms(), line.measured_departure_rms(), line.on_front() ? 1 : 0);
    if (line.has_price_s_per_percent())
      absl::StrAppendFormat(&csv, "%.4g", line.price_s_per_percent());
    csv += '\n';
  }
  return csv;
}

absl::StatusOr<v1::TradeoffResult> RunTradeoff(const TradeoffRequest& request,
                                               const Watcher& watcher) {
  const bool recorded = !request.recording.empty();
  EYEBOX_ASSIGN_OR_RETURN(const SourceOfTrial sources, recorded ? RecordedSources(request.recording)
                                                                : SimulatedSources(request.rig));
  EYEBOX_ASSIGN_OR_RETURN(const Tradeoff tradeoff,
                          MeasureTradeoff(sources, request.options, *SystemClock(), watcher));
  std::string source = recorded ? request.recording_name : request.rig.camera_uri;
  if (source.empty()) source = request.recording.filename().string();
  v1::TradeoffResult result = ToProto(tradeoff, request.options, source);
  if (recorded) {
    result.add_warnings(
        "trials share the recording's frames, so errors common to all of them (the flat's "
        "luminance, drift) are not seen, and the spread of trials is less than that of recordings");
  }
  if (!request.out.empty()) EYEBOX_RETURN_IF_ERROR(WriteFiles(request.out, result));
  return result;
}

}  // namespace eyebox::service
