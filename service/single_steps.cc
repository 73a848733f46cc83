#include "service/single_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/reader.h"
#include "fit/cube/table_file.h"
#include "fit/field/common_exponent.h"
#include "optics/uniformity/uniformity_map.h"
#include "service/results/activation.h"
#include "service/results/cube.h"
#include "service/results/field_verdict.h"
#include "service/results/reduction.h"
#include "service/results/scatter.h"
#include "service/results/uniformity.h"
#include "service/steps/calibrate.h"
#include "service/steps/drift.h"
#include "service/steps/known_geometry.h"
#include "service/steps/known_scale.h"
#include "service/steps/levels.h"
#include "service/steps/sensor.h"
#include "service/steps/within.h"

namespace eyebox::service {
namespace {

constexpr double kSameDrive = 1e-6;

// A calibrated camera and the series to look at.
struct Bench {
  std::unique_ptr<capture::RecordingReader> reader;
  std::string series;
  optics::Calibration calibration;
  KnownGlare glare;
};

absl::StatusOr<Bench> OpenBench(const SeriesChoice& choice, const Watcher& watcher) {
  Bench bench;
  EYEBOX_ASSIGN_OR_RETURN(bench.reader, capture::RecordingReader::Open(choice.recording));
  EYEBOX_ASSIGN_OR_RETURN(bench.series, ChooseSeries(*bench.reader, choice.series));
  // Fails on a wrong name at once, not after the calibration.
  EYEBOX_RETURN_IF_ERROR(LightCaptures(*bench.reader, bench.series).status());
  EYEBOX_ASSIGN_OR_RETURN(bench.glare, GlareOf(choice.scatter, bench.reader->Header()));
  EYEBOX_ASSIGN_OR_RETURN(
      bench.calibration,
      CalibrateCamera(*bench.reader, watcher, SensorFolder(choice.recording, choice.sensor)));
  EYEBOX_RETURN_IF_ERROR(UseScale(choice.scale, bench.calibration));
  return bench;
}

bool HasDrive(const StimulusCaptures& group, double drive) {
  return group.stimulus.drive &&
         std::all_of(group.stimulus.drive->begin(), group.stimulus.drive->end(),
                     [drive](double channel) { return std::abs(channel - drive) < kSameDrive; });
}

std::string NameOf(const StimulusCaptures& group) {
  if (!group.stimulus.drive) return "of unknown drive";
  const DriveRgb& drive = *group.stimulus.drive;
  return absl::StrFormat("(%.6g, %.6g, %.6g)", drive[0], drive[1], drive[2]);
}

absl::StatusOr<const StimulusCaptures*> ChooseStimulus(const std::vector<StimulusCaptures>& groups,
                                                       std::optional<double> drive) {
  if (!drive) return &groups.front();
  std::string known;
  for (const StimulusCaptures& group : groups) {
    if (HasDrive(group, *drive)) return &group;
    absl::StrAppend(&known, " ", NameOf(group));
  }
  return Missing(absl::StrFormat("level %.6g", *drive), "no capture of the series shows it",
                 "choose one of:" + known);
}

template <typename Result>
absl::StatusOr<Result> Located(const std::filesystem::path& recording,
                               absl::StatusOr<Result> result) {
  if (!result.ok()) return Within(recording, result.status());
  return result;
}

absl::StatusOr<v1::ReduceResult> Reduce(const SeriesChoice& choice, std::optional<double> drive,
                                        const std::filesystem::path& folder,
                                        const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const Bench bench, OpenBench(choice, watcher.Part(0, 0.8)));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.8, "merging the exposures"));
  EYEBOX_ASSIGN_OR_RETURN(const auto groups, LightCaptures(*bench.reader, bench.series));
  EYEBOX_ASSIGN_OR_RETURN(const StimulusCaptures* group, ChooseStimulus(groups, drive));
  EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel level,
                          ReduceCaptures(*bench.reader, *group, bench.calibration, choice.bracket));
  EYEBOX_ASSIGN_OR_RETURN(const auto glare, TakeScatterOut(bench.glare, level));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredDrift drift, MeasureDrift(*bench.reader));
  EYEBOX_ASSIGN_OR_RETURN(
      const auto corrected,
      CorrectForDriftWithin(*bench.reader, group->captures, drift.drift, level.luminance));
  EYEBOX_ASSIGN_OR_RETURN(v1::ReduceResult result,
                          DescribeReduction(level, bench.calibration, bench.series, folder));
  if (glare) AddScatterRemoval(*glare, result);
  result.mutable_warnings()->Add(drift.warnings.begin(), drift.warnings.end());
  if (!corrected) {
    result.add_warnings(
        "the stimulus was shown before or after all readings of the drift, and is not corrected "
        "for it");
  }
  if (!drive && groups.size() > 1) {
    result.add_warnings(absl::StrCat("the series shows ", groups.size(),
                                     " stimuli; this is the first that was recorded, drive ",
                                     NameOf(*group), ": choose another with --level"));
  }
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

absl::StatusOr<v1::UniformityResult> Map(const SeriesChoice& choice,
                                         const std::filesystem::path& folder,
                                         const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto geometry, KnownGeometry(choice.recording, choice.geometry));
  EYEBOX_ASSIGN_OR_RETURN(const Bench bench, OpenBench(choice, watcher.Part(0, 0.7)));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredLevels levels,
                          ReduceGreyLevels(*bench.reader, bench.series, bench.calibration,
                                           watcher.Part(0.7, 0.9), bench.glare));
  const GreyLevel& level = levels.reference;
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "uniformity map"));
  EYEBOX_ASSIGN_OR_RETURN(const optics::UniformityMap map,
                          optics::MeasureUniformity(level.reduced.luminance));
  EYEBOX_ASSIGN_OR_RETURN(v1::UniformityResult result,
                          DescribeUniformity(map, level.reduced.luminance, level.drive,
                                             bench.reader->Header().geometry, folder));
  EYEBOX_RETURN_IF_ERROR(AddFieldMap(geometry, map, folder, result));
  EYEBOX_RETURN_IF_ERROR(AddLevelIndependence(optics::TestLevelIndependence(levels.blocks),
                                              LevelBlockPx(levels.size), folder, result));
  if (level.glare) AddScatterRemoval(*level.glare, result);
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

absl::StatusOr<v1::ActivationResult> Fit(const SeriesChoice& choice,
                                         const fit::ActivationOptions& options, bool compare,
                                         const std::filesystem::path& folder,
                                         const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const Bench bench, OpenBench(choice, watcher.Part(0, 0.4)));
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredLevels levels,
                          ReduceGreyLevels(*bench.reader, bench.series, bench.calibration,
                                           watcher.Part(0.4, 0.9), bench.glare));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.9, "activation"));
  EYEBOX_ASSIGN_OR_RETURN(const fit::ActivationChoice activation,
                          fit::ChooseActivation(levels.series, options));
  EYEBOX_ASSIGN_OR_RETURN(const fit::CommonExponentFit field,
                          fit::FitCommonExponent(levels.Field()));
  v1::ActivationResult result = DescribeActivation(activation, levels.series);
  EYEBOX_ASSIGN_OR_RETURN(*result.mutable_field(), DescribeField(field, levels, folder));
  EYEBOX_RETURN_IF_ERROR(AddFieldVerdict(levels, folder, result));
  if (compare) AddComparison(fit::CompareActivations(levels.series), result);
  result.mutable_warnings()->Add(levels.warnings.begin(), levels.warnings.end());
  if (watcher.progress) watcher.progress({1, "done"});
  return result;
}

}  // namespace

absl::StatusOr<v1::ReduceResult> ReduceSeries(const SeriesChoice& choice,
                                              std::optional<double> drive,
                                              const std::filesystem::path& folder,
                                              const Watcher& watcher) {
  return Located(choice.recording, Reduce(choice, drive, folder, watcher));
}

absl::StatusOr<v1::UniformityResult> MapUniformity(const SeriesChoice& choice,
                                                   const std::filesystem::path& folder,
                                                   const Watcher& watcher) {
  return Located(choice.recording, Map(choice, folder, watcher));
}

absl::StatusOr<v1::ActivationResult> FitRecording(const SeriesChoice& choice,
                                                  const fit::ActivationOptions& options,
                                                  bool compare, const std::filesystem::path& folder,
                                                  const Watcher& watcher) {
  return Located(choice.recording, Fit(choice, options, compare, folder, watcher));
}

absl::StatusOr<v1::ActivationResult> FitCsv(const std::filesystem::path& file,
                                            const fit::ActivationOptions& options, bool compare) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::LevelSeries series, fit::ReadLevelSeriesCsv(file));
  EYEBOX_ASSIGN_OR_RETURN(const fit::ActivationChoice choice,
                          fit::ChooseActivation(series, options));
  v1::ActivationResult result = DescribeActivation(choice, series);
  if (compare) AddComparison(fit::CompareActivations(series), result);
  result.set_source(file.filename().string());
  return result;
}

absl::StatusOr<v1::CubeResult> DesignCube(const CubeRequest& request) {
  EYEBOX_ASSIGN_OR_RETURN(const fit::Activation activation,
                          ActivationOf(request.fit, request.fit_source));
  EYEBOX_ASSIGN_OR_RETURN(
      const fit::TableDesign table,
      fit::DesignTable(activation, request.target, request.size, request.design));
  EYEBOX_ASSIGN_OR_RETURN(const std::string bytes, fit::EncodeTable(table));
  EYEBOX_RETURN_IF_ERROR(WriteFileAtomically(request.out, bytes));
  v1::CubeResult result = DescribeCube(table, request.fit, request.out.filename().string(), bytes);
  for (const fit::StorageModel& storage : fit::ModelsOf(request.storage)) {
    EYEBOX_ASSIGN_OR_RETURN(const fit::StoredCertificate stored,
                            fit::CertifyStored(table, activation, request.design, storage));
    AddStored(stored, result);
  }
  return result;
}

}  // namespace eyebox::service
