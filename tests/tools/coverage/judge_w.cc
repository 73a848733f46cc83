#include "tests/tools/coverage/judge_w.h"

#include <cmath>
#include <numbers>
#include <string>

#include "fit/scatter/read_disk.h"
#include "optics/scatter/remove_glare.h"
#include "tests/tools/coverage/small_rig.h"

namespace eyebox {
namespace {

using service::SimulatedMeasurement;

constexpr double kDiskDiameters_deg[] = {0.4, 0.7, 1.0, 1.5, 2.5, 4.0, 6.0};
constexpr double kBlackDiameters_deg[] = {1.0, 2.0, 4.0};
constexpr double kReachDeg = 8;     // where the simulated tail ends
constexpr double kFieldDeg = 16;    // further than any pixel sees through it
constexpr double kNamed = 0.2;      // of an open combination: its parameters
constexpr double kDarkDiskDeg = 4;  // and the part of it, around its middle, that is judged:
constexpr int kDarkRadiusPx = 12;
const fit::DiskAim kAim{{47.5, 47.5}, kSmallRigDegPerPx};

double OnPlane(double diameter_deg) {
  const double half = diameter_deg / 2 * std::numbers::pi / 180;
  return 2 * std::tan(half) * 180 / std::numbers::pi;
}

bool StatesInterval(const fit::ScatterFit& fit, int parameter) {
  if (!(fit.parameters[parameter].sigma > 0)) return false;
  for (const fit::OpenCombination& open : fit.open) {
    if (std::abs(open.direction[parameter]) >= kNamed) return false;
  }
  const size_t bounds = fit.termination.find("at a bound");
  return bounds == std::string::npos ||
         fit.termination.find(fit.parameters[parameter].name, bounds) == std::string::npos;
}

}  // namespace

Stimulus Show(StimulusPattern pattern, double diameter_deg, double drive) {
  return {pattern, diameter_deg, DriveRgb{drive, drive, drive}};
}

absl::StatusOr<fit::FieldFit> FitW(SimulatedMeasurement& measurement,
                                   const optics::LuminanceImage& white) {
  fit::GlareSeries series{{}, kFieldDeg, "cd/m2", "simulated"};
  const auto add = [&](const Stimulus& stimulus, fit::GlarePattern pattern) -> absl::Status {
    const auto level = measurement.Measure(stimulus, kCoverageRepeats);
    if (!level.ok()) return level.status();
    const auto readings = fit::ReadDisk(level->luminance.image, measurement.calibration(), kAim,
                                        pattern, OnPlane(stimulus.diameter_deg));
    if (!readings.ok()) return readings.status();
    series.readings.insert(series.readings.end(), readings->begin(), readings->end());
    return absl::OkStatus();
  };
  absl::Status status =
      add(Show(StimulusPattern::kFullField, 0, 0), fit::GlarePattern::kBrightDisk);
  for (const double diameter : kDiskDiameters_deg) {
    status.Update(add(Show(StimulusPattern::kDisk, diameter, 1), fit::GlarePattern::kBrightDisk));
  }
  for (const double diameter : kBlackDiameters_deg) {
    status.Update(
        add(Show(StimulusPattern::kBlackDisk, diameter, 1), fit::GlarePattern::kBlackDisk));
  }
  const auto field =
      fit::ReadDisk(white.image, measurement.calibration(), kAim, fit::GlarePattern::kBlackDisk, 0);
  status.Update(field.status());
  if (!status.ok()) return status;
  series.readings.push_back(field->front());
  fit::FieldFitOptions options;
  options.fit.reach_deg = kReachDeg;
  return fit::FitScatterWithField(
      series, {white, kAim.axis, kSmallRigDegPerPx, 1, optics::Surround::kContinued}, options);
}

void JudgeW(const fit::ScatterFit& fit, const capture::SimParameters& rig, CoverageTable& table) {
  const capture::ScatterParameters& truth = rig.scatter;
  const double expected[] = {truth.core_sigma_px * kSmallRigDegPerPx, truth.tail_weight,
                             truth.tail_scale_px * kSmallRigDegPerPx, 2 * truth.tail_beta, 0};
  for (int i = 0; i < fit::kKernelParameters; ++i) {
    const fit::Parameter& parameter = fit.parameters[i];
    CoverageRow& row = table["w, " + parameter.name];
    if (StatesInterval(fit, i)) {
      row.Add({(parameter.value - expected[i]) / parameter.sigma});
    } else {
      ++row.without;
    }
  }
}

absl::Status JudgeCleanLuminance(const fit::FieldFit& w, const capture::SimParameters& rig,
                                 uint64_t seed, SimulatedMeasurement& measurement,
                                 const std::vector<Sample>& pixels, CoverageTable& table) {
  const SimulatedMeasurement clean(WithoutTail(rig), seed);
  const auto judge = [&](const std::string& name, const Stimulus& stimulus,
                         const optics::LuminanceImage& image,
                         const std::vector<Sample>& where) -> absl::Status {
    const auto truth = clean.LuminanceOf(stimulus);
    if (!truth.ok()) return truth.status();
    std::vector<double> pulls;
    for (const auto& [x, y] : where) {
      if (image.image.mask.at(x, y) != 0) continue;
      pulls.push_back(
          (image.image.value.at(x, y) - truth->at(x, y) * measurement.scale_error()) /
          std::hypot(std::sqrt(image.image.variance.at(x, y)), image.scatter_sigma.at(x, y)));
    }
    table[name].Add(pulls);
    return absl::OkStatus();
  };
  const Stimulus white = Show(StimulusPattern::kFullField, 0, 1);
  if (auto status = judge("luminance without glare, white", white, w.removal.luminance, pixels);
      !status.ok()) {
    return status;
  }
  const Stimulus dark = Show(StimulusPattern::kBlackDisk, kDarkDiskDeg, 1);
  const auto level = measurement.Measure(dark, kCoverageRepeats);
  if (!level.ok()) return level.status();
  const auto removed = optics::RemoveGlare(
      level->luminance,
      {w.fit.kernel, w.fit.glare_relative_sigma, kSmallRigDegPerPx, optics::Surround::kContinued});
  if (!removed.ok()) return removed.status();
  std::vector<Sample> inside;
  for (const auto& [x, y] : pixels) {
    inside.push_back({48 - kDarkRadiusPx + x * 2 * kDarkRadiusPx / 96,
                      48 - kDarkRadiusPx + y * 2 * kDarkRadiusPx / 96});
  }
  return judge("luminance without glare, black disk", dark, removed->luminance, inside);
}

}  // namespace eyebox
