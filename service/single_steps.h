// Each step of the pipeline by itself, for those who want no more than that.
#ifndef EYEBOX_SERVICE_SINGLE_STEPS_H_
#define EYEBOX_SERVICE_SINGLE_STEPS_H_

#include <filesystem>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "eyebox/v1/results.pb.h"
#include "fit/activation/fit_activation.h"
#include "fit/cube/design_table.h"
#include "service/steps/levels.h"
#include "service/steps/take_scatter_out.h"
#include "service/watcher.h"

namespace eyebox::service {

struct SeriesChoice {
  std::filesystem::path recording;
  std::optional<std::string> series;  // the main one, or the only one, unless given
  // Folder of the characterised sensor; empty: the copy in the recording, if there is one.
  std::filesystem::path sensor = {};
  ScatterChoice scatter = {};   // to be taken out of the luminance
  BracketOptions bracket = {};  // of ReduceSeries alone
  // scale.json and geometry.json; empty: no scale but the recording's, and the geometry that the
  // recording keeps, if there is one.
  std::filesystem::path scale = {};
  std::filesystem::path geometry = {};
};

// Merges the bracket of one stimulus of the series: the one of this grey drive value, else the
// first that was recorded, with a warning if there are several.
// Maps go into `folder` unless it is empty, likewise below.
// Errors: those of the recording and of ReduceLevel; NotFound (no such series or drive: lists
// them).
absl::StatusOr<v1::ReduceResult> ReduceSeries(const SeriesChoice& choice,
                                              std::optional<double> drive,
                                              const std::filesystem::path& folder,
                                              const Watcher& watcher);

// g(x) of the brightest usable level. Errors: those of the recording; FailedPrecondition.
absl::StatusOr<v1::UniformityResult> MapUniformity(const SeriesChoice& choice,
                                                   const std::filesystem::path& folder,
                                                   const Watcher& watcher);

// Activation at the reference point and over the field, and whether one exponent serves it.
// `compare`: with the table of all models under all weightings, likewise below.
absl::StatusOr<v1::ActivationResult> FitRecording(const SeriesChoice& choice,
                                                  const fit::ActivationOptions& options,
                                                  bool compare, const std::filesystem::path& folder,
                                                  const Watcher& watcher);

// A series measured elsewhere. Errors: NotFound, InvalidArgument (a flat line included),
// FailedPrecondition (it cannot be fitted).
absl::StatusOr<v1::ActivationResult> FitCsv(const std::filesystem::path& file,
                                            const fit::ActivationOptions& options, bool compare);

struct CubeRequest {
  v1::ActivationResult fit;
  std::string fit_source;  // where it came from, for messages
  fit::TableTarget target = fit::TableTarget::kHdrp;
  int size = 32;
  std::filesystem::path out;
  fit::DesignOptions design;
  // Certified after each of its models by itself and after all of them together.
  fit::StorageModel storage;
};
// Designs, certifies and writes `out`. Errors: NotFound, InvalidArgument, the errno of the disk.
absl::StatusOr<v1::CubeResult> DesignCube(const CubeRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SINGLE_STEPS_H_
