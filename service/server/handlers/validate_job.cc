#include "service/server/handlers/validate_job.h"

#include <set>
#include <string>
#include <vector>

#include "capture/base/status.h"
#include "service/server/handlers/validate_run.h"
#include "service/server/store/names.h"
#include "service/server/store/rig_names.h"

namespace eyebox::service {
namespace {

constexpr NameRule kFileRule = {"a file", "", 8, kIdCharacters};
constexpr NameRule kNewRecordingRule = {
    "a new recording", "", 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-"};
constexpr int kMostPredictions = 1000;
constexpr double kLongestTimeoutS = 86400;
constexpr double kLongestCostS = 3600;

// A path below the served folder that a request names.
struct Source {
  std::string field;
  std::string path;  // empty: none
  bool folder = false;
};

Source FolderOf(const std::string& field, const v1::SeriesSource& source) {
  return {field + ".recording", source.recording(), true};
}

template <typename Work>
Source SeriesOrCsv(const std::string& verb, const Work& work) {
  if (work.has_csv()) return {verb + ".csv", work.csv(), false};
  return FolderOf(verb + ".series", work.series());
}

std::vector<Source> SourcesOf(const v1::CreateJobRequest& request) {
  switch (request.work_case()) {
    case v1::CreateJobRequest::kRun:
      if (!request.run().has_recording()) return {};
      return {{"recording", request.run().recording(), true}};
    case v1::CreateJobRequest::kReduce:
      return {FolderOf("reduce.source", request.reduce().source())};
    case v1::CreateJobRequest::kUniformity:
      return {FolderOf("uniformity.source", request.uniformity().source())};
    case v1::CreateJobRequest::kCharacterize:
      return {{"characterize.recording", request.characterize().recording(), true}};
    case v1::CreateJobRequest::kFit:
      return {SeriesOrCsv("fit", request.fit())};
    case v1::CreateJobRequest::kScatter:
      return {SeriesOrCsv("scatter", request.scatter())};
    case v1::CreateJobRequest::kContrast:
      return {FolderOf("contrast.source", request.contrast().source())};
    case v1::CreateJobRequest::kVerify:
      return {SeriesOrCsv("verify", request.verify())};
    case v1::CreateJobRequest::kPredict: {
      std::vector<Source> sources = {{"predict.csv", request.predict().csv(), false}};
      if (const std::string& cube = request.predict().cube(); !cube.empty()) {
        sources.push_back({"predict.cube", cube, false});
      }
      return sources;
    }
    case v1::CreateJobRequest::kTradeoff:
      if (!request.tradeoff().has_recording()) return {};
      return {{"tradeoff.recording", request.tradeoff().recording(), true}};
    case v1::CreateJobRequest::kPlan: {
      std::vector<Source> sources = {{"plan.scene", request.plan().scene(), false}};
      if (request.plan().has_recording()) {
        sources.push_back({"plan.recording", request.plan().recording(), true});
      }
      return sources;
    }
    default:
      return {};
  }
}

absl::Status OneOf(const std::string& field, const std::string& value,
                   const std::set<std::string>& allowed) {
  if (value.empty() || allowed.contains(value)) return absl::OkStatus();
  std::string list;
  for (const std::string& one : allowed) list += (list.empty() ? "" : ", ") + one;
  return BadField(field, Quoted(value) + " is none", "give one of " + list + ", or nothing");
}

absl::Status ValidateCapture(const v1::CaptureWork& work) {
  EYEBOX_RETURN_IF_ERROR(
      CheckName(kNewRecordingRule, "capture.recording_id", work.recording_id()).status());
  if (work.source_case() == v1::CaptureWork::SOURCE_NOT_SET) {
    return BadField("capture.source", "is missing", "give a rig, or a simulated one");
  }
  if (work.has_simulated()) EYEBOX_RETURN_IF_ERROR(ValidateRig(work.simulated()));
  if (work.has_rig()) {
    EYEBOX_RETURN_IF_ERROR(CheckName(kRigNameRule, "capture.rig", work.rig()).status());
  }
  if (!work.session() && work.plan().captures().empty()) {
    return BadField("capture.plan", "holds no capture",
                    "give what MakePlan returns, or set session");
  }
  if (!(work.client_timeout_s() >= 0 && work.client_timeout_s() <= kLongestTimeoutS)) {
    return BadField("capture.client_timeout_s", "is " + std::to_string(work.client_timeout_s()),
                    "give 0 to 86400");
  }
  return absl::OkStatus();
}

absl::Status ValidateCosts(const std::string& field, const v1::CaptureCosts& costs) {
  const auto refuse = [&](const char* name, double value) {
    return BadField(field + "." + name, "is " + std::to_string(value), "give 0 to 3600");
  };
  const auto makes_sense = [](double seconds) { return seconds >= 0 && seconds <= kLongestCostS; };
  if (!makes_sense(costs.stimulus_s())) return refuse("stimulus_s", costs.stimulus_s());
  if (!makes_sense(costs.frame_s())) return refuse("frame_s", costs.frame_s());
  return absl::OkStatus();
}

absl::Status ValidateTradeoff(const v1::TradeoffWork& work) {
  if (work.source_case() == v1::TradeoffWork::SOURCE_NOT_SET) {
    return BadField("tradeoff.source", "is missing", "give a simulated rig or a recording");
  }
  if (work.has_simulated()) EYEBOX_RETURN_IF_ERROR(ValidateRig(work.simulated()));
  if (work.trials() != 0 && (work.trials() < 2 || work.trials() > 1000)) {
    return BadField("tradeoff.trials", "is " + std::to_string(work.trials()),
                    "give 2 to 1000, or 0 for 24");
  }
  return ValidateCosts("tradeoff.costs", work.costs());
}

absl::Status ValidatePlan(const v1::PlanWork& work) {
  if (work.pilot_case() == v1::PlanWork::PILOT_NOT_SET) {
    return BadField("plan.pilot", "is missing", "give a simulated rig or a recording");
  }
  if (work.has_simulated()) EYEBOX_RETURN_IF_ERROR(ValidateRig(work.simulated()));
  if (!(work.tolerance() >= 0 && work.tolerance() < 1)) {
    return BadField("plan.tolerance", "is " + std::to_string(work.tolerance()),
                    "give a share above 0 and below 1, or 0 for 0.02");
  }
  if (work.has_budget_s() && !(work.budget_s() > 0)) {
    return BadField("plan.budget_s", "is " + std::to_string(work.budget_s()),
                    "give a time above 0, or leave it out");
  }
  return ValidateCosts("plan.costs", work.costs());
}

// Where scatter may be taken out.
absl::Status ValidateSeries(const std::string& field, const v1::SeriesSource& source) {
  if (!source.surround().empty() && !source.has_scatter()) {
    return BadField(field + ".surround", "stands without scatter",
                    "give the scatter that is to be taken out, or leave it empty");
  }
  return OneOf(field + ".surround", source.surround(), {"unknown", "continued", "dark"});
}

absl::Status ValidatePlainSeries(const std::string& field, const v1::SeriesSource& source) {
  if (!source.has_scatter() && source.surround().empty()) return absl::OkStatus();
  return BadField(field + ".scatter", "is not taken out by this kind of job",
                  "leave scatter and surround of the source empty");
}

absl::Status ValidateValues(const v1::CreateJobRequest& request) {
  switch (request.work_case()) {
    case v1::CreateJobRequest::kReduce:
      EYEBOX_RETURN_IF_ERROR(ValidateSeries("reduce.source", request.reduce().source()));
      return ValidateClip("reduce.clip_sigmas", request.reduce().clip_sigmas());
    case v1::CreateJobRequest::kUniformity:
      return ValidateSeries("uniformity.source", request.uniformity().source());
    case v1::CreateJobRequest::kFit:
      return ValidateSeries("fit.series", request.fit().series());
    case v1::CreateJobRequest::kContrast:
      return ValidatePlainSeries("contrast.source", request.contrast().source());
    case v1::CreateJobRequest::kCube:
      if (request.cube().size() != 0 &&
          (request.cube().size() < 2 || request.cube().size() > 256)) {
        return BadField("cube.size", "is " + std::to_string(request.cube().size()),
                        "give 2 to 129 (ptb: 256), or 0 for the default");
      }
      return OneOf("cube.target", request.cube().target(), {"hdrp", "pps", "resolve", "ptb"});
    case v1::CreateJobRequest::kScatter:
      EYEBOX_RETURN_IF_ERROR(ValidatePlainSeries("scatter.series", request.scatter().series()));
      if (request.scatter().predict_deg_size() <= kMostPredictions) return absl::OkStatus();
      return BadField("scatter.predict_deg", "holds too many diameters", "give at most 1000");
    case v1::CreateJobRequest::kVerify:
      EYEBOX_RETURN_IF_ERROR(ValidatePlainSeries("verify.series", request.verify().series()));
      return OneOf("verify.input", request.verify().input(), {"srgb", "linear"});
    case v1::CreateJobRequest::kPredict:
      return OneOf("predict.material", request.predict().material(), {"unlit", "lambertian"});
    case v1::CreateJobRequest::kCapture:
      return ValidateCapture(request.capture());
    case v1::CreateJobRequest::kTradeoff:
      return ValidateTradeoff(request.tradeoff());
    case v1::CreateJobRequest::kPlan:
      return ValidatePlan(request.plan());
    default:
      return absl::OkStatus();
  }
}

}  // namespace

absl::Status ValidateJob(const v1::CreateJobRequest& request) {
  EYEBOX_RETURN_IF_ERROR(CheckName(kRequestIdRule, "request_id", request.request_id()).status());
  if (request.work_case() == v1::CreateJobRequest::WORK_NOT_SET) {
    return BadField("work", "is missing", "give one of the verbs");
  }
  if (request.has_run()) return ValidateRunWork(request.run());
  for (const Source& source : SourcesOf(request)) {
    EYEBOX_RETURN_IF_ERROR(
        CheckName(source.folder ? kRecordingRule : kFileRule, source.field, source.path).status());
  }
  return ValidateValues(request);
}

absl::Status CheckSources(const RootFolder& data, const v1::CreateJobRequest& request) {
  for (const Source& source : SourcesOf(request)) {
    const absl::Status there =
        source.folder ? data.OpenFolder(source.path).status() : data.OpenFile(source.path).status();
    if (!there.ok()) return WithField(there, source.field);
  }
  if (!request.has_capture()) return absl::OkStatus();
  const v1::CaptureWork& work = request.capture();
  if (work.has_rig()) {
    EYEBOX_ASSIGN_OR_RETURN(const std::string rig,
                            CheckName(kRigNameRule, "capture.rig", work.rig()));
    const absl::Status there = data.OpenFile(rig + std::string(kRigSuffix)).status();
    if (!there.ok()) return WithField(there, "capture.rig");
  }
  if (!data.OpenFolder(work.recording_id()).ok()) return absl::OkStatus();
  return WithField(absl::AlreadyExistsError(Complaint("capture.recording_id",
                                                      work.recording_id() + " is there already",
                                                      "give the recording another name")),
                   "capture.recording_id");
}

}  // namespace eyebox::service
