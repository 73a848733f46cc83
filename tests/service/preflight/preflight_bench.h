// A simulated rig, with its photodiode, on a clock that needs no waiting.
#ifndef EYEBOX_TESTS_SERVICE_PREFLIGHT_PREFLIGHT_BENCH_H_
#define EYEBOX_TESTS_SERVICE_PREFLIGHT_PREFLIGHT_BENCH_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/base/clock.h"
#include "capture/camera/sim/sim_rig.h"
#include "capture/photodiode/sim/sim_photodiode.h"
#include "service/preflight/preflight.h"

namespace eyebox::service {

// Every look at it is 5 ms later than the one before.
class TickingClock final : public Clock {
 public:
  int64_t MonotonicNs() const override { return now_ns_ += 5'000'000; }
  int64_t RealNs() const override { return now_ns_; }

 private:
  mutable int64_t now_ns_ = 0;
};

struct PreflightBench {
  capture::SimParameters parameters = {};
  std::optional<capture::StrobeLight> light = {};  // a photodiode that sees it; none without
  std::vector<double> exposures_s = {0.0125, 0.075, 0.45};
  uint64_t seed = 1;

  std::vector<Check> Run() const {
    const TickingClock clock;
    auto rig =
        capture::OpenSimRig({.name = "t", .camera_uri = "sim:t", .seed = seed}, parameters, &clock);
    EXPECT_TRUE(rig.ok()) << rig.status();
    std::unique_ptr<capture::Photodiode> photodiode;
    if (light) {
      auto made =
          capture::MakeSimPhotodiode({.uri = "sim:t", .seed = seed}, {.light = *light}, &clock);
      EXPECT_TRUE(made.ok()) << made.status();
      photodiode = *std::move(made);
    }
    auto checks = RunPreflight(*rig, photodiode.get(), {.exposures_s = exposures_s}, {});
    EXPECT_TRUE(checks.ok()) << checks.status();
    return checks.ok() ? *checks : std::vector<Check>();
  }
};

inline std::vector<std::string> NamesWith(const std::vector<Check>& checks, Verdict verdict) {
  std::vector<std::string> names;
  for (const Check& check : checks) {
    if (check.verdict == verdict) names.push_back(check.name);
  }
  return names;
}

inline const Check& Named(const std::vector<Check>& checks, std::string_view name) {
  const auto found = std::ranges::find(checks, name, &Check::name);
  EXPECT_NE(found, checks.end()) << name;
  return *found;
}

inline double FigureOf(const Check& check, std::string_view name) {
  const auto found = std::ranges::find(check.figures, name, &Figure::name);
  EXPECT_NE(found, check.figures.end()) << check.name << " has no " << name;
  return found == check.figures.end() ? 0 : found->value;
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_PREFLIGHT_PREFLIGHT_BENCH_H_
