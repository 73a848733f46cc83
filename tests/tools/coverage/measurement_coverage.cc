// How often the stated 95 % intervals cover the truth, over simulated recordings, each through
// another w (tails of 0.1 % to 30 %): luminance at random pixels as it was seen and with the glare
// taken out, g raw and smooth, the parameters of w, the luminance scale.
// `measurement_coverage [RECORDINGS [with-w|without-w [FIRST_SEED]]]`, 200 and seed 1000 unless
// given. A parameter of w counts where the fit states an interval for it; how often it states none
// is in the last column.
// Tells on stderr how far it is. Exit 1 where a row lies further from 95 % than 2 % and chance (3
// standard errors) allow.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "capture/base/random.h"
#include "optics/reduce/flat_variance.h"
#include "optics/uniformity/level_independence.h"
#include "optics/uniformity/uniformity_map.h"
#include "service/planner/simulated_measurement.h"
#include "tests/tools/coverage/coverage_table.h"
#include "tests/tools/coverage/judge_w.h"
#include "tests/tools/coverage/small_rig.h"

namespace eyebox {
namespace {

using service::SimulatedMeasurement;

constexpr int kPixels = 5;                // random ones of each recording
constexpr double kLevels[] = {0.4, 0.7};  // beside white, for level independence
constexpr int kBlockPx = 8;

std::vector<Sample> RandomPixels(ImageSize size, uint64_t seed) {
  RandomStream random({seed, 5});
  std::vector<Sample> pixels;
  for (int k = 0; k < kPixels; ++k) {
    pixels.push_back({static_cast<int>(random.Below(size.width_px)),
                      static_cast<int>(random.Below(size.height_px))});
  }
  return pixels;
}

void JudgeLuminance(const optics::LuminanceImage& white, const Image<double>& truth,
                    double scale_error, const std::vector<Sample>& pixels, CoverageTable& table) {
  std::vector<double> whole, noise;
  double measured = 0, true_sum = 0;
  for (size_t i = 0; i < truth.pixels().size(); ++i) {
    if (white.image.mask.pixels()[i] != 0) continue;
    measured += white.image.value.pixels()[i];
    true_sum += truth.pixels()[i];
  }
  for (const auto& [x, y] : pixels) {
    if (white.image.mask.at(x, y) != 0) continue;
    const double value = white.image.value.at(x, y);
    const double variance = white.image.variance.at(x, y);
    const double scale = white.scale_relative_sigma * value;
    whole.push_back((value - truth.at(x, y)) / std::sqrt(variance + scale * scale));
    noise.push_back((value - truth.at(x, y) * scale_error) / std::sqrt(variance));
  }
  table["luminance, with the scale"].Add(whole);
  table["luminance, apart from the scale"].Add(noise);
  table["luminance scale"].Add({(measured / true_sum - 1) / white.scale_relative_sigma});
}

// `truth` is 1 on average where the map is.
void JudgeG(const std::string& name, const optics::UniformityMap& map, const Image<double>& truth,
            const std::vector<Sample>& pixels, CoverageTable& table) {
  const auto reference = optics::UniformityOptions().reference_radius_fraction * 96;
  double disk = 0, count = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      if (std::hypot(x - 47.5, y - 47.5) > reference || map.raw.mask.at(x, y) != 0) continue;
      disk += truth.at(x, y);
      ++count;
    }
  }
  const double middle =
      (truth.at(47, 47) + truth.at(48, 47) + truth.at(47, 48) + truth.at(48, 48)) / 4;
  std::vector<double> raw, smooth, alternative;
  for (const auto& [x, y] : pixels) {
    if (map.raw.mask.at(x, y) != 0) continue;
    raw.push_back((map.raw.value.at(x, y) - truth.at(x, y) / (disk / count)) /
                  std::sqrt(map.raw.variance.at(x, y)));
    const double g = truth.at(x, y) / middle;
    smooth.push_back((map.smooth.At(x, y) - g) / map.smooth.SigmaAt(x, y));
    alternative.push_back((map.alternative->At(x, y) - g) / map.alternative->SigmaAt(x, y));
  }
  table[name + ", raw"].Add(raw);
  table[name + ", smooth"].Add(smooth);
  table[name + ", smooth, other kind"].Add(alternative);
}

absl::StatusOr<double> LevelPValue(SimulatedMeasurement& measurement,
                                   const optics::LuminanceImage& white) {
  std::vector<optics::LevelBlocks> levels;
  const auto add = [&](double drive, const optics::LuminanceImage& image) {
    levels.push_back(
        {drive,
         optics::Binned(optics::WithoutFlat(image.image, measurement.calibration()), kBlockPx)});
  };
  for (const double drive : kLevels) {
    const auto level =
        measurement.Measure(Show(StimulusPattern::kFullField, 0, drive), kCoverageRepeats);
    if (!level.ok()) return level.status();
    add(drive, level->luminance);
  }
  add(1, white);
  const auto test = optics::TestLevelIndependence(levels);
  if (!test.ok()) return test.status();
  return test->p_value;
}

absl::Status JudgeScatter(SimulatedMeasurement& measurement, const capture::SimParameters& rig,
                          uint64_t seed, const optics::LuminanceImage& white,
                          const std::vector<Sample>& pixels, CoverageTable& table) {
  const auto w = FitW(measurement, white);
  if (!w.ok()) return w.status();
  JudgeW(w->fit, rig, table);
  const auto clean = optics::MeasureUniformity(w->removal.luminance);
  if (!clean.ok()) return clean.status();
  const auto truth = SimulatedMeasurement(WithoutTail(rig), seed)
                         .LuminanceOf(Show(StimulusPattern::kFullField, 0, 1));
  if (!truth.ok()) return truth.status();
  JudgeG("g, scatter taken out", *clean, *truth, pixels, table);
  return JudgeCleanLuminance(*w, rig, seed, measurement, pixels, table);
}

absl::Status Judge(const capture::SimParameters& rig, uint64_t seed, bool with_w,
                   CoverageTable& table, int& rejected) {
  SimulatedMeasurement measurement(rig, seed);
  if (auto status = measurement.Calibrate(); !status.ok()) return status;
  const Stimulus stimulus = Show(StimulusPattern::kFullField, 0, 1);
  const auto white = measurement.Measure(stimulus, kCoverageRepeats);
  if (!white.ok()) return white.status();
  const auto luminance = measurement.LuminanceOf(stimulus);
  if (!luminance.ok()) return luminance.status();
  const Image<double>& seen = *luminance;
  const auto pixels = RandomPixels(seen.size(), seed);
  JudgeLuminance(white->luminance, seen, measurement.scale_error(), pixels, table);
  const auto map = optics::MeasureUniformity(white->luminance);
  if (!map.ok()) return map.status();
  JudgeG("g as the camera sees it", *map, seen, pixels, table);
  if (with_w) {
    const absl::Status judged =
        JudgeScatter(measurement, rig, seed, white->luminance, pixels, table);
    if (!judged.ok()) return judged;
  }
  const auto p_value = LevelPValue(measurement, white->luminance);
  if (!p_value.ok()) return p_value.status();
  rejected += *p_value < 0.05 ? 1 : 0;
  return absl::OkStatus();
}

int Main(int recordings, bool with_w, uint64_t first_seed) {
  CoverageTable table;
  int rejected = 0;
  int failed = 0;
  for (int k = 0; k < recordings; ++k) {
    const uint64_t seed = first_seed + static_cast<uint64_t>(k);
    const absl::Status status = Judge(SmallRigOfAnyScatter(seed), seed, with_w, table, rejected);
    if ((k + 1) % 10 == 0) std::fprintf(stderr, "%d of %d recordings\n", k + 1, recordings);
    if (status.ok()) continue;
    ++failed;
    std::printf("recording %d: %s\n", k, std::string(status.message()).c_str());
  }
  const bool sound = PrintCoverage(table);
  std::printf("level independence rejected at 5 %%: %d of %d\n", rejected, recordings);
  return sound && failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace eyebox

int main(int argc, char** argv) {
  const int recordings = argc > 1 ? std::atoi(argv[1]) : 200;
  if (recordings < 1) {
    std::fprintf(stderr, "measurement_coverage: give a number of recordings above 0\n");
    return 2;
  }
  const uint64_t first_seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1000;
  return eyebox::Main(recordings, argc <= 2 || std::string(argv[2]) != "without-w", first_seed);
}
