// What plans promise and keep: random scenes and tolerances on rigs with random parameters.
// `planner_calibration [SCENES [TRIALS]]`, 100 scenes unless given, each plan measured on 4 other
// sensors. A scene is one draw of rig, region, things to look at and tolerance. Exit 1 where the
// share of errors within the promised bound lies outside 93 to 97 %.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "capture/base/clock.h"
#include "capture/base/parallel.h"
#include "capture/base/random.h"
#include "capture/base/status.h"
#include "service/planner/cheapest.h"
#include "service/planner/measure_setting.h"
#include "service/planner/pilot.h"
#include "service/planner/simulated_measurement.h"

namespace eyebox::service {
namespace {

constexpr uint64_t kStream = 31;

struct Draw {
  capture::SimParameters rig;
  Need need;
  double tolerance = 0;
};

double Between(RandomStream& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}
double LogBetween(RandomStream& random, double low, double high) {
  return low * std::pow(high / low, random.Uniform());
}

void DrawRig(RandomStream& random, capture::SimParameters& rig) {
  rig.sensor.size = {.width_px = 96, .height_px = 72};
  rig.geometry = {.focal_length_px = 131.9, .principal_x_px = 47.5, .principal_y_px = 35.5};
  const double gamma = Between(random, 1.8, 2.6);
  for (auto& channel : rig.display.channels) {
    channel.gamma = gamma * Between(random, 0.97, 1.03);
  }
  rig.display.minimum_luminance_cd_m2 = LogBetween(random, 0.05, 0.5);
  rig.nonuniformity.falloff = Between(random, 0.02, 0.4);
  rig.nonuniformity.tilt_x = Between(random, -0.03, 0.03);
  rig.scatter.tail_weight = LogBetween(random, 0.002, 0.1);
  rig.sensor.responsivity_e_s_per_cd_m2 = Between(random, 8000, 20300);
  rig.sensor.read_noise_e = Between(random, 2, 10);
}

void DrawNeed(RandomStream& random, Need& need) {
  need.radius_deg = Between(random, 2, 20);
  need.disk_deg = random.Uniform() < 0.5 ? 0 : Between(random, 3, 15);
  need.u_from = 0.05;
  const bool coloured = random.Uniform() < 0.3;
  need.fixed = random.Uniform() < 0.5;
  const int patches = 1 + static_cast<int>(random.Below(4));
  for (int i = 0; i < patches; ++i) {
    const double u = LogBetween(random, 0.05, 1);
    if (!coloured) {
      need.grey_u.push_back(u);
      continue;
    }
    DriveRgb colour;
    for (double& channel : colour) channel = u * Between(random, 0.3, 1);
    need.colours.push_back(colour);
  }
}

Draw DrawScene(uint64_t scene) {
  RandomStream random({kStream, scene});
  Draw draw;
  DrawRig(random, draw.rig);
  DrawNeed(random, draw.need);
  draw.tolerance = LogBetween(random, 0.002, 0.03);
  return draw;
}

struct Outcome {
  bool promised = false;
  double within_tolerance = 0;  // share of errors
  double within_bound = 0;
  double bound = 0;
  double seconds = 0;
  double cheapest_s = 0;  // of the finer grid
  std::string error;
};

LeverGrid FinerGrid() {
  LeverGrid grid;
  grid.frames = {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32};
  grid.even_levels = {5, 6, 7, 9, 12};
  grid.design_s.clear();
  for (double seconds = 1; seconds < 100; seconds *= 1.12) grid.design_s.push_back(seconds);
  grid.shown_frames.clear();
  for (int frames = 1; frames <= 128; frames = std::max(frames + 1, frames * 5 / 4)) {
    grid.shown_frames.push_back(frames);
  }
  grid.map_frames = {1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32};
  grid.white_frames = {0, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32};
  grid.orders = {1, 2, 3, 4, 5, 6};
  grid.block_px = {1, 2, 3, 4};
  return grid;
}

absl::Status Measure(const Draw& draw, uint64_t seed, const Planned& planned, int trials,
                     Outcome& outcome) {
  for (int t = 0; t < trials; ++t) {
    SimulatedMeasurement source(draw.rig, seed + 1 + static_cast<uint64_t>(t));
    const auto region = RegionPixels(source.Size(), source.Geometry(), draw.need.radius_deg);
    EYEBOX_ASSIGN_OR_RETURN(const Truth truth, source.TruthFor(draw.need.disk_deg));
    EYEBOX_ASSIGN_OR_RETURN(
        const Measured measured,
        MeasureSetting(source, planned.setting, draw.need, region, *SystemClock()));
    const std::vector<double> errors = ErrorsOf(measured, truth, draw.need, region);
    double within_tolerance = 0;
    double within_bound = 0;
    for (const double error : errors) {
      within_tolerance += std::abs(error) <= draw.tolerance ? 1 : 0;
      within_bound += std::abs(error) <= planned.prediction.bound_95 ? 1 : 0;
    }
    const double weight = 1 / (static_cast<double>(errors.size()) * trials);
    outcome.within_tolerance += within_tolerance * weight;
    outcome.within_bound += within_bound * weight;
  }
  return absl::OkStatus();
}

absl::Status Try(uint64_t scene, int trials, Outcome& outcome) {
  const Draw draw = DrawScene(scene);
  const uint64_t seed = 1000 * (scene + 1);
  SimulatedMeasurement source(draw.rig, seed);
  PilotOptions options;
  options.primaries = !draw.need.colours.empty();
  EYEBOX_ASSIGN_OR_RETURN(const Pilot pilot, MeasurePilot(source, *SystemClock(), options));
  EYEBOX_ASSIGN_OR_RETURN(Predictor predictor, Predictor::Make(pilot, draw.need, {}));
  EYEBOX_ASSIGN_OR_RETURN(const Search search, FindCheapest(predictor, draw.tolerance, {}));
  outcome.promised = search.cheapest.has_value();
  if (!outcome.promised) return absl::OkStatus();
  outcome.bound = search.cheapest->prediction.bound_95;
  outcome.seconds = search.cheapest->prediction.capture_s;
  EYEBOX_ASSIGN_OR_RETURN(const Search finer,
                          FindCheapest(predictor, draw.tolerance, {}, FinerGrid()));
  outcome.cheapest_s = finer.cheapest ? finer.cheapest->prediction.capture_s : 0;
  return Measure(draw, seed, *search.cheapest, trials, outcome);
}

int Main(int scenes, int trials) {
  std::vector<Outcome> outcomes(static_cast<size_t>(scenes));
  ForEachInParallel(scenes, [&](int i) {
    Outcome& outcome = outcomes[static_cast<size_t>(i)];
    const absl::Status status = Try(static_cast<uint64_t>(i), trials, outcome);
    outcome.error = std::string(status.message());
    std::fprintf(stderr, ".");
  });
  std::fprintf(stderr, "\n");
  int promised = 0;
  int failed = 0;
  double within_tolerance = 0;
  double within_bound = 0;
  double dearest = 0;
  std::printf("scene tolerance    bound within tolerance within bound   seconds  finer grid\n");
  for (int i = 0; i < scenes; ++i) {
    const Outcome& o = outcomes[static_cast<size_t>(i)];
    if (!o.error.empty()) {
      ++failed;
      std::printf("%5d %s\n", i, o.error.c_str());
      continue;
    }
    if (!o.promised) {
      std::printf("%5d %8.3f %% refused\n", i, 100 * DrawScene(static_cast<uint64_t>(i)).tolerance);
      continue;
    }
    ++promised;
    within_tolerance += o.within_tolerance;
    within_bound += o.within_bound;
    if (o.cheapest_s > 0) dearest = std::max(dearest, o.seconds / o.cheapest_s);
    std::printf("%5d %8.3f %% %7.3f %% %14.1f %% %11.1f %% %9.2f %11.2f\n", i,
                100 * DrawScene(static_cast<uint64_t>(i)).tolerance, 100 * o.bound,
                100 * o.within_tolerance, 100 * o.within_bound, o.seconds, o.cheapest_s);
  }
  if (promised == 0) return 1;
  within_bound /= promised;
  std::printf(
      "%d promised, %d failed: %.2f %% of errors within the tolerance, %.2f %% within the "
      "predicted bound; at most %.2f times the time of the cheapest of a finer grid\n",
      promised, failed, 100 * within_tolerance / promised, 100 * within_bound, dearest);
  return failed == 0 && within_bound >= 0.93 && within_bound <= 0.97 ? 0 : 1;
}

}  // namespace
}  // namespace eyebox::service

int main(int argc, char** argv) {
  const int scenes = argc > 1 ? std::atoi(argv[1]) : 100;
  const int trials = argc > 2 ? std::atoi(argv[2]) : 4;
  if (scenes < 1 || trials < 1) {
    std::fprintf(stderr, "planner_calibration: give numbers above 0\n");
    return 2;
  }
  return eyebox::service::Main(scenes, trials);
}
