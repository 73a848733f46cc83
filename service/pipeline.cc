#include "service/pipeline.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "capture/base/clock.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/camera/sim/truth.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "fit/activation/fit_activation.h"
#include "fit/cube/design_table.h"
#include "fit/cube/table_file.h"
#include "fit/field/common_exponent.h"
#include "optics/uniformity/uniformity_map.h"
#include "service/budget.h"
#include "service/preflight/certification.h"
#include "service/report/report.h"
#include "service/result_json.h"
#include "service/results/activation.h"
#include "service/results/cube.h"
#include "service/results/field_verdict.h"
#include "service/results/parameter.h"
#include "service/results/reduction.h"
#include "service/results/report_input.h"
#include "service/results/uniformity.h"
#include "service/steps/calibrate.h"
#include "service/steps/known_geometry.h"
#include "service/steps/known_scale.h"
#include "service/steps/levels.h"
#include "service/steps/record_plan.h"
#include "service/steps/sensor.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

// What the steps find, in the order in which they find it.
struct Findings {
  optics::Calibration calibration;
  MeasuredLevels levels;
  optics::UniformityMap map;
  fit::ActivationChoice activation;
  fit::CommonExponentFit field;
  std::vector<fit::TableDesign> tables;
  std::optional<optics::ViewGeometry> geometry;  // where it is better known than the recording says
};

absl::StatusOr<Findings> Measure(capture::RecordingReader& recording, const RunOptions& options,
                                 const std::filesystem::path& sensor, const Watcher& watcher) {
  Findings found;
  EYEBOX_ASSIGN_OR_RETURN(const std::string series, ChooseSeries(recording, std::nullopt));
  EYEBOX_ASSIGN_OR_RETURN(found.calibration,
                          CalibrateCamera(recording, watcher.Part(0, 0.4), sensor));
  EYEBOX_RETURN_IF_ERROR(UseScale(options.scale, found.calibration));
  EYEBOX_ASSIGN_OR_RETURN(const KnownGlare glare, GlareOf(options.scatter, recording.Header()));
  EYEBOX_ASSIGN_OR_RETURN(
      found.levels, ReduceGreyLevels(recording, series, found.calibration, watcher.Part(0.4, 0.8),
                                     glare, {.clip_sigmas = options.clip_sigmas}));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.8, "uniformity map"));
  EYEBOX_ASSIGN_OR_RETURN(found.map,
                          optics::MeasureUniformity(found.levels.reference.reduced.luminance));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.85, "activation"));
  EYEBOX_ASSIGN_OR_RETURN(found.activation, fit::ChooseActivation(found.levels.series));
  EYEBOX_ASSIGN_OR_RETURN(found.field, fit::FitCommonExponent(found.levels.Field()));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "lookup tables and certificates"));
  const fit::Activation& activation = found.activation.best.activation;
  for (const auto& [target, size] : {std::pair(fit::TableTarget::kHdrp, options.hdrp_cube_size),
                                     std::pair(fit::TableTarget::kPps, options.pps_strip_size)}) {
    EYEBOX_ASSIGN_OR_RETURN(fit::TableDesign table, fit::DesignTable(activation, target, size));
    found.tables.push_back(std::move(table));
  }
  return found;
}

constexpr const char* kTableFiles[] = {"linearize.cube", "linearize.png"};  // as in tables

absl::Status DescribeSteps(const Findings& found, const capture::RecordingHeader& header,
                           const std::filesystem::path& out, v1::RunResult& result) {
  const GreyLevel& reference = found.levels.reference;
  EYEBOX_ASSIGN_OR_RETURN(*result.mutable_uniformity(),
                          DescribeUniformity(found.map, reference.reduced.luminance,
                                             reference.drive, header.geometry, out));
  EYEBOX_RETURN_IF_ERROR(AddFieldMap(found.geometry, found.map, out, *result.mutable_uniformity()));
  EYEBOX_RETURN_IF_ERROR(AddLevelIndependence(optics::TestLevelIndependence(found.levels.blocks),
                                              LevelBlockPx(found.levels.size), out,
                                              *result.mutable_uniformity()));
  if (reference.glare) AddScatterRemoval(*reference.glare, *result.mutable_uniformity());
  *result.mutable_activation() = DescribeActivation(found.activation, found.levels.series);
  EYEBOX_ASSIGN_OR_RETURN(*result.mutable_activation()->mutable_field(),
                          DescribeField(found.field, found.levels, out));
  EYEBOX_RETURN_IF_ERROR(AddFieldVerdict(found.levels, out, *result.mutable_activation()));
  EYEBOX_ASSIGN_OR_RETURN(
      *result.mutable_reduction(),
      DescribeReduction(reference.reduced, found.calibration, "reference level", out));
  for (size_t i = 0; i < found.tables.size(); ++i) {
    EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, fit::EncodeTable(found.tables[i]));
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(out / kTableFiles[i], bytes));
    *result.add_cubes() = DescribeCube(found.tables[i], result.activation(), kTableFiles[i], bytes);
  }
  return absl::OkStatus();
}

void AddSummary(v1::RunResult& result) {
  for (const v1::Parameter& parameter : result.activation().parameters()) {
    if (parameter.name() == "gamma" || parameter.name() == "minimum_luminance") {
      *result.add_parameters() = parameter;
    }
  }
  *result.add_parameters() = MaximumLuminance(result.activation());
}

void AddWarnings(const MeasuredLevels& levels, v1::RunResult& result) {
  const auto add = [&result](const auto& warnings) {
    for (const std::string& warning : warnings) {
      const auto& known = result.warnings();
      if (std::find(known.begin(), known.end(), warning) == known.end()) {
        result.add_warnings(warning);
      }
    }
  };
  add(levels.warnings);
  add(result.reduction().warnings());
  add(result.uniformity().warnings());
  add(result.activation().warnings());
  for (const v1::CubeResult& cube : result.cubes()) add(cube.warnings());
}

void AddCertification(const Certification& certification, v1::RunResult& result) {
  result.set_certified(certification.certified);
  result.set_certification_reason(certification.reason);
  if (!certification.certified) {
    result.add_warnings(absl::StrCat("not certified: ", certification.reason));
  }
}

void ListFiles(v1::RunResult& result) {
  std::vector<std::string> files = {"uniformity.json", "activation.json", "budget.json",
                                    "result.json", "report.html"};
  files.insert(files.end(), std::begin(kTableFiles), std::end(kTableFiles));
  for (const auto* maps : {&result.uniformity().maps(), &result.reduction().maps(),
                           &result.activation().field().maps()}) {
    for (const v1::MapFile& map : *maps) files.push_back(map.file());
  }
  std::sort(files.begin(), files.end());
  result.mutable_files()->Add(files.begin(), files.end());
}

absl::Status WriteJson(const std::filesystem::path& file,
                       const google::protobuf::Message& message) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(message));
  return WriteFileAtomically(file, json);
}

absl::Status WriteReport(const std::filesystem::path& file, const Findings& found,
                         const capture::RecordingHeader& header, const v1::RunResult& result) {
  const Image<float> smooth_g = found.map.smooth.Values();
  EYEBOX_ASSIGN_OR_RETURN(const std::string html,
                          report::RenderReport(MakeReportInput({header, result, found.map, smooth_g,
                                                                found.activation.best.activation,
                                                                found.tables, found.geometry})));
  return WriteFileAtomically(file, html);
}

// result.json comes last: where it stands, everything that it names is there.
absl::StatusOr<v1::RunResult> Write(const Findings& found, const capture::RecordingHeader& header,
                                    const Certification& certification,
                                    const std::filesystem::path& out) {
  v1::RunResult result;
  std::error_code absent;
  std::filesystem::remove(out / "result.json", absent);
  EYEBOX_RETURN_IF_ERROR(DescribeSteps(found, header, out, result));
  AddSummary(result);
  AddWarnings(found.levels, result);
  AddCertification(certification, result);
  ListFiles(result);
  EYEBOX_RETURN_IF_ERROR(WriteJson(out / "uniformity.json", result.uniformity()));
  EYEBOX_RETURN_IF_ERROR(WriteJson(out / "activation.json", result.activation()));
  EYEBOX_ASSIGN_OR_RETURN(
      const v1::BudgetResult budget,
      MakeBudget(found.activation.best, found.levels.series, {.shares = found.levels.shares}));
  EYEBOX_RETURN_IF_ERROR(WriteJson(out / "budget.json", budget));
  EYEBOX_RETURN_IF_ERROR(WriteReport(out / "report.html", found, header, result));
  EYEBOX_RETURN_IF_ERROR(WriteJson(out / "result.json", result));
  return result;
}

absl::Status ValidateOptions(const RunOptions& options) {
  if (options.hdrp_cube_size < 2 || options.hdrp_cube_size > 129) {
    return BadInput("hdrp_cube_size", absl::StrCat("is ", options.hdrp_cube_size),
                    "give 2 to 129 entries, as the Unity project's grading LUT size says");
  }
  if (options.pps_strip_size < 2 || options.pps_strip_size > 32) {
    return BadInput("pps_strip_size", absl::StrCat("is ", options.pps_strip_size),
                    "give 2 to 32 entries");
  }
  const double clip = options.clip_sigmas;
  if (clip != 0 && !(clip >= 3 && clip <= 100)) {
    return BadInput("clip_sigmas", absl::StrCat("is ", clip), "give 3 to 100, or 0 for none");
  }
  return absl::OkStatus();
}

constexpr double kCaptureShare = 0.5;  // of the time of a run that captures first

// The captures as they stand on disk, whatever was planned.
CapturePlan PlanOf(const capture::RecordingReader& recording) {
  CapturePlan plan;
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (!entry.suspect.empty()) continue;  // not to be used, so not to be replayed
    plan.captures.push_back(entry.spec);
    plan.captures.back().repeats = entry.frame_count;
  }
  return plan;
}

}  // namespace

absl::StatusOr<v1::RunResult> RunRecording(const std::filesystem::path& recording,
                                           const std::filesystem::path& out,
                                           const RunOptions& options, const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(ValidateOptions(options));
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  EYEBOX_ASSIGN_OR_RETURN(const auto geometry, KnownGeometry(recording, options.geometry));
  auto found = Measure(*reader, options, SensorFolder(recording, options.sensor), watcher);
  if (!found.ok()) return Within(recording, found.status());
  found->geometry = geometry;
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.95, "writing results"));
  const Certification certification = CertificationOf(recording, reader->Header());
  EYEBOX_ASSIGN_OR_RETURN(v1::RunResult result,
                          Write(*found, reader->Header(), certification, out));
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

absl::StatusOr<v1::RunResult> RunRig(const capture::RigConfig& config,
                                     const std::filesystem::path& recording,
                                     const std::filesystem::path& out, const RunOptions& options,
                                     const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(ValidateOptions(options));
  v1::PreflightResult preflight;
  if (!options.preflight.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(preflight, ReadPreflight(options.preflight));
  }
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  if (!options.sensor.empty()) rig.config.sensor = options.sensor.string();
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, capture::MakeGreyPlan({}));
  EYEBOX_RETURN_IF_ERROR(RecordPlan(rig, plan, recording, watcher.Part(0, kCaptureShare)).status());
  if (rig.origin == capture::RecordingOrigin::kSimulated) {
    EYEBOX_RETURN_IF_ERROR(capture::WriteSimTruth(recording, config));
  }
  if (!options.preflight.empty()) {
    EYEBOX_RETURN_IF_ERROR(WritePreflight(recording, preflight));
  }
  EYEBOX_RETURN_IF_ERROR(KeepGeometry(options.geometry, recording));
  return RunRecording(recording, out, options, watcher.Part(kCaptureShare, 1));
}

absl::StatusOr<v1::RunResult> ReplayRecording(const std::filesystem::path& recording,
                                              const std::filesystem::path& replayed,
                                              const std::filesystem::path& out,
                                              const RunOptions& options, const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(ValidateOptions(options));
  EYEBOX_ASSIGN_OR_RETURN(const auto original, capture::RecordingReader::Open(recording));
  capture::RigConfig config = original->Header().rig;
  config.camera_uri = "replay:" + recording.string();
  // They would look at another display, or at none.
  config.photodiode_uri.clear();
  config.trigger_uri.clear();
  config.camera_trigger_line.clear();
  config.sensor = SensorFolder(recording, {}).string();
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  EYEBOX_RETURN_IF_ERROR(
      RecordPlan(rig, PlanOf(*original), replayed, watcher.Part(0, kCaptureShare)).status());
  if (std::filesystem::exists(recording / kPreflightFile)) {
    EYEBOX_ASSIGN_OR_RETURN(const v1::PreflightResult preflight, ReadPreflight(recording));
    EYEBOX_RETURN_IF_ERROR(WritePreflight(replayed, preflight));
  }
  if (std::filesystem::exists(recording / kGeometryFile)) {
    EYEBOX_RETURN_IF_ERROR(KeepGeometry(recording / kGeometryFile, replayed));
  }
  return RunRecording(replayed, out, options, watcher.Part(kCaptureShare, 1));
}

}  // namespace eyebox::service
