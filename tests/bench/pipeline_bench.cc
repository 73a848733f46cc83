// The whole run, from a recording to proven tables and the report, against reading the recording
// once with every checksum (what `eyebox verify-files` does), in the same run, for cameras of 0.3
// to 12 megapixels and stacks of 5 to 65 levels. Counters:
//   reads     time of the run over that of the reading, each the least disturbed of its runs
//   MB_per_s  bytes of the frames over the time of the run
// Needs 2 GB in $TMPDIR.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/plan.h"
#include "capture/recording/reader.h"
#include "service/pipeline.h"
#include "service/steps/record_plan.h"

namespace eyebox::service {
namespace {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string form = (std::filesystem::temp_directory_path() / "eyebox-bench-XXXXXX").string();
    if (mkdtemp(form.data()) == nullptr) std::abort();
    path_ = form;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// The default rig with another camera, of the same field.
capture::SimParameters WithSensor(ImageSize size) {
  capture::SimParameters parameters;
  const double finer = static_cast<double>(size.width_px) / parameters.sensor.size.width_px;
  parameters.sensor.size = size;
  parameters.geometry.focal_length_px *= finer;
  parameters.geometry.principal_x_px = 0.5 * (size.width_px - 1);
  parameters.geometry.principal_y_px = 0.5 * (size.height_px - 1);
  return parameters;
}

// Returns the frames.
absl::StatusOr<int64_t> Record(ImageSize size, int levels, const std::filesystem::path& recording) {
  const capture::RigConfig config = {.name = "bench", .camera_uri = "sim:rift-s-like"};
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig,
                          capture::OpenSimRig(config, WithSensor(size), SystemClock()));
  capture::PlanOptions options;
  options.levels = levels;
  options.exposures_s = {0.0125, 0.075};
  options.dark_repeats = options.flat_repeats = 2;
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, capture::MakeGreyPlan(options));
  EYEBOX_ASSIGN_OR_RETURN(const capture::RunReport report, RecordPlan(rig, plan, recording, {}));
  return report.frames;
}

template <typename Work>
double Seconds(const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void WholeRun(benchmark::State& state) {
  const ImageSize size{static_cast<int>(state.range(0)), static_cast<int>(state.range(1))};
  const TemporaryFolder folder;
  const auto recording = folder.path() / "recording";
  const auto frames = Record(size, static_cast<int>(state.range(2)), recording);
  if (!frames.ok()) return state.SkipWithError(frames.status().ToString().c_str());
  double least_read_s = 1e9, least_run_s = 1e9;
  for (auto _ : state) {
    absl::Status status;
    least_read_s =
        std::min(least_read_s,
                 Seconds([&] { status.Update(capture::VerifyRecording(recording).status()); }));
    least_run_s =
        std::min(least_run_s, Seconds([&] {
                   status.Update(RunRecording(recording, folder.path() / "out", {}, {}).status());
                 }));
    if (!status.ok()) return state.SkipWithError(status.ToString().c_str());
  }
  const double frame_bytes = static_cast<double>(size.PixelCount() * sizeof(uint16_t));
  state.counters["read_ms"] = 1e3 * least_read_s;
  state.counters["run_ms"] = 1e3 * least_run_s;
  state.counters["reads"] = least_run_s / least_read_s;
  state.counters["MB_per_s"] = static_cast<double>(*frames) * frame_bytes / 1e6 / least_run_s;
}

BENCHMARK(WholeRun)
    ->ArgNames({"width_px", "height_px", "levels"})
    ->Args({640, 480, 17})
    ->Args({640, 480, 5})
    ->Args({640, 480, 33})
    ->Args({640, 480, 65})
    ->Args({1280, 960, 17})
    ->Args({2048, 1536, 17})
    ->Args({4096, 3000, 5})
    ->Iterations(3)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::service
