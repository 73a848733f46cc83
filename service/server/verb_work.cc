#include "service/server/verb_work.h"

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "service/contrast.h"
#include "service/planner/plan_measurement.h"
#include "service/planner/tradeoff_result.h"
#include "service/predict_rows.h"
#include "service/result_json.h"
#include "service/results/characterize.h"
#include "service/scatter.h"
#include "service/scene/read_scene.h"
#include "service/server/store/rigs.h"
#include "service/single_steps.h"
#include "service/steps/characterize.h"
#include "service/verify.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

struct CubeForm {
  std::string_view name;
  fit::TableTarget target;
  const char* file;
  int usual_size;
};
// As `eyebox cube --target` has it.
constexpr CubeForm kCubeForms[] = {{"hdrp", fit::TableTarget::kHdrp, "hdrp.cube", 32},
                                   {"pps", fit::TableTarget::kPps, "pps.png", 32},
                                   {"resolve", fit::TableTarget::kResolve, "resolve.cube", 32},
                                   {"ptb", fit::TableTarget::kPtb, "ptb.csv", 256}};

// One verb under way: what it opened stays open, and is known to the client by its own name.
class Verb {
 public:
  Verb(const RootFolder& data, const Assignment& assignment, const Watcher& watcher)
      : data_(data), out_(assignment.out), watcher_(watcher) {
    names_.emplace_back(out_.string() + "/", "");
  }

  absl::Status CarryOut(const v1::CreateJobRequest& request) {
    return WithNames(Dispatch(request));
  }

 private:
  absl::Status Dispatch(const v1::CreateJobRequest& request) {
    switch (request.work_case()) {
      case v1::CreateJobRequest::kReduce:
        return Reduce(request.reduce());
      case v1::CreateJobRequest::kUniformity:
        return Uniformity(request.uniformity());
      case v1::CreateJobRequest::kCharacterize:
        return Characterize(request.characterize());
      case v1::CreateJobRequest::kFit:
        return Fit(request.fit());
      case v1::CreateJobRequest::kCube:
        return Cube(request.cube());
      case v1::CreateJobRequest::kScatter:
        return Scatter(request.scatter());
      case v1::CreateJobRequest::kContrast:
        return Contrast(request.contrast());
      case v1::CreateJobRequest::kVerify:
        return Judge(request.verify());
      case v1::CreateJobRequest::kPredict:
        return Predict(request.predict());
      case v1::CreateJobRequest::kTradeoff:
        return PriceLevers(request.tradeoff());
      case v1::CreateJobRequest::kPlan:
        return Plan(request.plan());
      default:
        return absl::InternalError(Complaint("work", "is none that is known here",
                                             "report this as a fault of the program"));
    }
  }

  absl::Status Reduce(const v1::ReduceWork& work) {
    EYEBOX_ASSIGN_OR_RETURN(SeriesChoice choice, Choose(work.source()));
    choice.bracket = {.clip_sigmas = work.clip_sigmas(), .repair_defects = work.repair_defects()};
    return Write(ReduceSeries(choice, work.has_level() ? std::optional(work.level()) : std::nullopt,
                              out_, watcher_));
  }

  absl::Status Uniformity(const v1::UniformityWork& work) {
    EYEBOX_ASSIGN_OR_RETURN(const SeriesChoice choice, Choose(work.source()));
    return Write(MapUniformity(choice, out_, watcher_));
  }

  absl::Status Characterize(const v1::CharacterizeWork& work) {
    EYEBOX_ASSIGN_OR_RETURN(const fs::path recording, OpenFolder(work.recording()));
    EYEBOX_ASSIGN_OR_RETURN(const CharacterizedSensor sensor,
                            CharacterizeRecording(recording, watcher_));
    return Write(DescribeSensor(sensor, out_));
  }

  absl::Status Fit(const v1::FitWork& work) {
    if (work.has_csv()) {
      EYEBOX_ASSIGN_OR_RETURN(const fs::path csv, OpenFile(work.csv()));
      return Write(FitCsv(csv, {}, work.compare()));
    }
    EYEBOX_ASSIGN_OR_RETURN(const SeriesChoice choice, Choose(work.series()));
    return Write(FitRecording(choice, {}, work.compare(), out_, watcher_));
  }

  absl::Status Cube(const v1::CubeWork& work) {
    const std::string target = work.target().empty() ? "hdrp" : work.target();
    for (const CubeForm& form : kCubeForms) {
      if (form.name != target) continue;
      return Write(DesignCube({.fit = work.fit(),
                               .fit_source = "fit",
                               .target = form.target,
                               .size = work.size() == 0 ? form.usual_size : work.size(),
                               .out = out_ / form.file,
                               .design = {},
                               .storage = {}}));
    }
    return BadInput("cube.target", "\"" + target + "\" is none", "give hdrp, pps, resolve or ptb");
  }

  absl::Status Scatter(const v1::ScatterWork& work) {
    ScatterRequest request;
    if (work.has_csv()) {
      EYEBOX_ASSIGN_OR_RETURN(request.source, OpenFile(work.csv()));
    } else {
      EYEBOX_ASSIGN_OR_RETURN(request.source, OpenFolder(work.series().recording()));
      if (work.series().has_series()) request.series = work.series().series();
    }
    request.predict_deg = {work.predict_deg().begin(), work.predict_deg().end()};
    request.out = out_;
    return Write(MeasureScatter(request, watcher_));
  }

  absl::Status Contrast(const v1::ContrastWork& work) {
    ContrastRequest request;
    EYEBOX_ASSIGN_OR_RETURN(request.recording, OpenFolder(work.source().recording()));
    if (work.source().has_series()) request.series = work.source().series();
    if (work.has_scatter()) {
      EYEBOX_ASSIGN_OR_RETURN(request.scatter, Put("scatter.json", work.scatter()));
    }
    return Write(MeasureContrast(request, watcher_));
  }

  absl::Status Judge(const v1::VerifyWork& work) {
    VerifyRequest request;
    if (work.has_csv()) {
      EYEBOX_ASSIGN_OR_RETURN(request.measured, OpenFile(work.csv()));
    } else {
      EYEBOX_ASSIGN_OR_RETURN(request.measured, OpenFolder(work.series().recording()));
      if (work.series().has_series()) request.series = work.series().series();
    }
    if (work.has_certificate()) {
      EYEBOX_ASSIGN_OR_RETURN(request.certificate, Put("certificate.json", work.certificate()));
    }
    request.input = work.input();
    request.folder = out_;
    return Write(Verify(request, watcher_));
  }

  absl::Status Predict(const v1::PredictWork& work) {
    RowPredictionRequest request;
    EYEBOX_ASSIGN_OR_RETURN(request.csv, OpenFile(work.csv()));
    if (!work.cube().empty()) {
      EYEBOX_ASSIGN_OR_RETURN(request.cube, OpenFile(work.cube()));
    }
    request.material =
        work.material() == "unlit" ? fit::RowMaterial::kUnlit : fit::RowMaterial::kLambertian;
    request.published = work.published();
    request.out = out_ / "predicted.csv";
    return Write(PredictRows(request));
  }

  absl::Status PriceLevers(const v1::TradeoffWork& work) {
    TradeoffRequest request;
    if (work.has_recording()) {
      EYEBOX_ASSIGN_OR_RETURN(request.recording, OpenFolder(work.recording()));
      request.recording_name = work.recording();
    } else {
      request.rig = ConfigOf(work.simulated());
    }
    if (work.trials() != 0) request.options.trials = work.trials();
    request.options.costs = CostsOf(work.costs());
    request.out = out_;
    return Write(RunTradeoff(request, watcher_));
  }

  absl::Status Plan(const v1::PlanWork& work) {
    PlanRequest request;
    EYEBOX_ASSIGN_OR_RETURN(request.scene, OpenFile(work.scene()));
    EYEBOX_ASSIGN_OR_RETURN(const SceneInput scene, ReadScene(request.scene));
    if (!scene.cube.empty()) {
      return BadInput(work.scene(), "it names a cube_file, and no path of a client is followed",
                      "plan with the command line, or leave the cube out");
    }
    if (work.has_recording()) {
      EYEBOX_ASSIGN_OR_RETURN(request.pilot, OpenFolder(work.recording()));
    } else {
      request.rig = ConfigOf(work.simulated());
    }
    if (work.tolerance() != 0) request.tolerance = work.tolerance();
    if (work.has_budget_s()) request.budget_s = work.budget_s();
    request.costs = CostsOf(work.costs());
    request.out = out_ / "plan.textproto";
    return Write(PlanMeasurement(request, watcher_));
  }

  static Costs CostsOf(const v1::CaptureCosts& asked) {
    Costs costs;
    if (asked.has_stimulus_s()) costs.stimulus_s = asked.stimulus_s();
    if (asked.has_frame_s()) costs.frame_s = asked.frame_s();
    return costs;
  }

  absl::StatusOr<SeriesChoice> Choose(const v1::SeriesSource& source) {
    SeriesChoice choice;
    EYEBOX_ASSIGN_OR_RETURN(choice.recording, OpenFolder(source.recording()));
    if (source.has_series()) choice.series = source.series();
    if (!source.has_scatter()) return choice;
    EYEBOX_ASSIGN_OR_RETURN(choice.scatter.file, Put("scatter.json", source.scatter()));
    if (source.surround() == "continued") choice.scatter.surround = optics::Surround::kContinued;
    if (source.surround() == "dark") choice.scatter.surround = optics::Surround::kDark;
    return choice;
  }

  // What a request brought stays beside the results that came of it.
  absl::StatusOr<fs::path> Put(const std::string& name, const google::protobuf::Message& message) {
    EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(message));
    EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(out_ / name, json));
    return out_ / name;
  }

  absl::StatusOr<fs::path> OpenFolder(const std::string& name) {
    return Keep(data_.OpenFolder(name), name);
  }
  absl::StatusOr<fs::path> OpenFile(const std::string& name) {
    return Keep(data_.OpenFile(name), name);
  }
  absl::StatusOr<fs::path> Keep(absl::StatusOr<OwnedFd> fd, const std::string& name) {
    EYEBOX_RETURN_IF_ERROR(fd.status());
    open_.push_back(*std::move(fd));
    names_.emplace_back(open_.back().Path().string(), name);
    return open_.back().Path();
  }

  template <typename Message>
  absl::Status Write(const absl::StatusOr<Message>& result) {
    EYEBOX_RETURN_IF_ERROR(result.status());
    EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(*result));
    return WriteFileAtomically(out_ / "result.json", Renamed(json));
  }

  absl::Status WithNames(const absl::Status& status) const {
    return status.ok() ? status : absl::Status(status.code(), Renamed(status.message()));
  }

  // A client knows a file by the name that it gave; how the server got hold of it says nothing.
  std::string Renamed(absl::string_view text) const { return absl::StrReplaceAll(text, names_); }

  const RootFolder& data_;
  const fs::path out_;
  const Watcher& watcher_;
  std::deque<OwnedFd> open_;
  std::vector<std::pair<std::string, std::string>> names_;
};

}  // namespace

absl::Status CarryOutVerb(const RootFolder& data, const Assignment& assignment,
                          const Watcher& watcher) {
  return Verb(data, assignment, watcher).CarryOut(assignment.request);
}

}  // namespace eyebox::service
