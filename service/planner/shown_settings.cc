#include "service/planner/shown_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fit/cube/goal.h"
#include "service/planner/measure_setting.h"

namespace eyebox::service {
namespace {

constexpr int kUsualDarks = 8;

// Drive values of what is looked at, each once, ascending luminance.
std::vector<DriveRgb> DrivesOf(const Predictor& predictor) {
  const Pilot& pilot = predictor.pilot();
  const auto drive_of = [](const fit::Activation& a, double u) {
    return std::min(fit::DriveForLuminance(a, u * a.Luminance(1)), 1.0);
  };
  std::vector<DriveRgb> drives;
  for (const double u : predictor.need().grey_u) {
    const double drive = drive_of(pilot.activation.activation, u);
    drives.push_back({drive, drive, drive});
  }
  for (const DriveRgb& u : predictor.need().colours) {
    DriveRgb& drive = drives.emplace_back();
    for (size_t c = 0; c < u.size(); ++c) {
      drive[c] = drive_of(pilot.primaries[c].activation, u[c]);
    }
  }
  std::ranges::sort(drives);
  const auto repeated = std::ranges::unique(drives);
  drives.erase(repeated.begin(), repeated.end());
  std::ranges::stable_sort(drives, {},
                           [&](const DriveRgb& drive) { return LuminanceOf(pilot, drive); });
  return drives;
}

struct OneFrame {
  size_t exposure = 0;
  double relative_variance = std::numeric_limits<double>::infinity();
};

// What one frame of `exposure` tells of it.
OneFrame FrameOf(const Predictor& predictor, const DriveRgb& drive, size_t exposure) {
  const Pilot& pilot = predictor.pilot();
  std::vector<int> frames(pilot.exposures_s.size(), 0);
  frames[exposure] = 1;
  const double luminance = LuminanceOf(pilot, drive);
  const double variance =
      LuminanceVariance(pilot, luminance, pilot.response_at_reference, frames, kUsualDarks);
  return {exposure, variance / (luminance * luminance)};
}

// The exposure that tells most for its time.
OneFrame BestFrameOf(const Predictor& predictor, const DriveRgb& drive) {
  OneFrame best;
  double least = std::numeric_limits<double>::infinity();
  const auto& exposures_s = predictor.pilot().exposures_s;
  for (size_t k = 0; k < exposures_s.size(); ++k) {
    const OneFrame frame = FrameOf(predictor, drive, k);
    const double price = frame.relative_variance * (exposures_s[k] + predictor.costs().frame_s);
    if (!(price < least)) continue;
    least = price;
    best = frame;
  }
  return best;
}

// One frame of each: of `exposure` where it tells something, else of the best.
std::vector<OneFrame> FramesOfAll(const Predictor& predictor, const std::vector<DriveRgb>& drives,
                                  std::optional<size_t> exposure) {
  std::vector<OneFrame> frames;
  for (const DriveRgb& drive : drives) {
    const OneFrame best = BestFrameOf(predictor, drive);
    const OneFrame asked = exposure ? FrameOf(predictor, drive, *exposure) : best;
    frames.push_back(std::isfinite(asked.relative_variance) ? asked : best);
  }
  return frames;
}

// As precise as each other: `most` of the one that a frame tells least of.
std::vector<ShownFrames> Shown(const std::vector<DriveRgb>& drives,
                               const std::vector<OneFrame>& of_one, int most, size_t exposures) {
  double worst = 0;
  for (const OneFrame& frame : of_one) worst = std::max(worst, frame.relative_variance);
  std::vector<ShownFrames> shown;
  for (size_t i = 0; i < drives.size(); ++i) {
    ShownFrames& thing = shown.emplace_back(drives[i], std::vector<int>(exposures, 0));
    thing.frames[of_one[i].exposure] =
        std::max(1, static_cast<int>(std::ceil(most * of_one[i].relative_variance / worst)));
  }
  return shown;
}

void AddMaps(const Predictor& predictor, const LeverGrid& grid, Setting setting,
             std::vector<Setting>& settings) {
  setting.tier = FieldTier::kNone;
  setting.tier_size = 0;
  setting.levels.clear();
  settings.push_back(setting);
  std::vector<std::vector<LevelFrames>> images;  // what the map is made of
  if (predictor.need().disk_deg == 0) images.emplace_back();
  const size_t exposure = BestFrameOf(predictor, {1, 1, 1}).exposure;
  for (const int frames : grid.map_frames) {
    LevelFrames white{1, std::vector<int>(predictor.pilot().exposures_s.size(), 0)};
    white.frames[exposure] = frames;
    images.push_back({white});
  }
  for (const auto& image : images) {
    setting.levels = image;
    setting.tier = FieldTier::kSmooth;
    for (const int order : grid.orders) {
      setting.tier_size = order;
      settings.push_back(setting);
    }
    setting.tier = FieldTier::kBlocks;
    for (const int side : grid.block_px) {
      setting.tier_size = side;
      settings.push_back(setting);
    }
  }
}

}  // namespace

std::vector<Setting> ShownSettings(const Predictor& predictor, const LeverGrid& grid) {
  const Need& need = predictor.need();
  if (!need.fixed || (need.grey_u.empty() && need.colours.empty())) return {};
  // What colours take is told by primaries; Predictor says so where they were not measured.
  if (!need.colours.empty() && predictor.pilot().primaries.empty()) return {};
  const std::vector<DriveRgb> drives = DrivesOf(predictor);
  const size_t exposures = predictor.pilot().exposures_s.size();
  std::vector<Setting> settings;
  Setting setting;
  setting.name = "plan";
  setting.table_size = 0;
  for (size_t k = 0; k <= exposures; ++k) {
    const auto of_one =
        FramesOfAll(predictor, drives, k < exposures ? std::optional(k) : std::nullopt);
    const bool told = std::ranges::all_of(
        of_one, [](const OneFrame& frame) { return std::isfinite(frame.relative_variance); });
    if (!told) continue;
    for (const int frames : grid.shown_frames) {
      setting.shown = Shown(drives, of_one, frames, exposures);
      AddMaps(predictor, grid, setting, settings);
    }
  }
  return settings;
}

}  // namespace eyebox::service
