// The whole way from a recording to proven tables; pipeline.cc reads as the paragraph of the
// method.
#ifndef EYEBOX_SERVICE_PIPELINE_H_
#define EYEBOX_SERVICE_PIPELINE_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "eyebox/v1/results.pb.h"
#include "service/steps/take_scatter_out.h"
#include "service/watcher.h"

namespace eyebox::service {

struct RunOptions {
  int hdrp_cube_size = 32;  // 2 to 129
  int pps_strip_size = 32;  // 2 to 32
  double clip_sigmas = 0;   // 3 to 100: frames of a level so far off are left out; 0: none are
  // Of a rig that is captured: preflight.json, or the folder that holds it, to be kept beside the
  // recording. Without one the result is not certified.
  std::filesystem::path preflight = {};
  // Folder of the characterised sensor; empty: that of the rig, else the copy in the recording,
  // else the sensor is estimated from the frames.
  std::filesystem::path sensor = {};
  // scale.json and geometry.json; empty: no scale but the recording's, and the geometry that the
  // recording keeps, if there is one. A rig that is captured keeps the geometry that is given.
  std::filesystem::path scale = {};
  std::filesystem::path geometry = {};
  ScatterChoice scatter = {};  // to be taken out of the luminance
};

// Reduces, maps, fits, designs and certifies, and writes into `out` (created if missing):
// uniformity.json, activation.json, budget.json, linearize.cube, linearize.png, result.json,
// report.html and the maps as NPY. The files depend on the recording's content and the options
// alone: no time, no path, no host. A file appears whole or not at all.
//
// Errors: those of the recording (NotFound, DataLoss, InvalidArgument), FailedPrecondition (the
// recording cannot give what was asked: says what to record), Cancelled, the errno of the disk.
absl::StatusOr<v1::RunResult> RunRecording(const std::filesystem::path& recording,
                                           const std::filesystem::path& out,
                                           const RunOptions& options, const Watcher& watcher);

// Captures the default grey plan of `rig` into `recording` (which must not exist), then as above.
// Errors: also Unavailable (device).
absl::StatusOr<v1::RunResult> RunRig(const capture::RigConfig& rig,
                                     const std::filesystem::path& recording,
                                     const std::filesystem::path& out, const RunOptions& options,
                                     const Watcher& watcher);

// Shows the captures of `recording` to the replay camera and records them again, then as above.
absl::StatusOr<v1::RunResult> ReplayRecording(const std::filesystem::path& recording,
                                              const std::filesystem::path& replayed,
                                              const std::filesystem::path& out,
                                              const RunOptions& options, const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PIPELINE_H_
