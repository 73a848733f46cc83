#include "service/planner/setting.h"

#include <numeric>

namespace eyebox::service {
namespace {

constexpr int kPrimaries = 3;

double SecondsOf(const std::vector<int>& frames, const std::vector<double>& exposures_s,
                 const Costs& costs) {
  double seconds = costs.stimulus_s;
  for (size_t k = 0; k < frames.size(); ++k) {
    seconds += frames[k] * (exposures_s[k] + costs.frame_s);
  }
  return seconds;
}

// Darks, or flats.
std::vector<int> CalibrationFrames(const Setting& setting) {
  std::vector<int> frames;
  for (const bool used : ExposuresInUse(setting)) {
    frames.push_back(used ? setting.calibration_frames : 0);
  }
  return frames;
}

int Sum(const std::vector<int>& frames) { return std::accumulate(frames.begin(), frames.end(), 0); }

}  // namespace

std::string_view NameOf(FieldTier tier) {
  switch (tier) {
    case FieldTier::kNone:
      return "none";
    case FieldTier::kSmooth:
      return "smooth";
    case FieldTier::kBlocks:
      return "blocks";
  }
  return "";
}

std::vector<bool> ExposuresInUse(const Setting& setting) {
  std::vector<bool> used(MapFrames(setting).size(), false);
  const auto add = [&](const std::vector<int>& frames) {
    for (size_t k = 0; k < used.size(); ++k) used[k] = used[k] || frames[k] > 0;
  };
  for (const LevelFrames& level : setting.levels) add(level.frames);
  for (const ShownFrames& thing : setting.shown) add(thing.frames);
  return used;
}

const std::vector<int>& MapFrames(const Setting& setting) {
  return setting.levels.empty() ? setting.shown.back().frames : setting.levels.back().frames;
}

std::vector<int> DiskFrames(const Setting& setting) {
  std::vector<int> frames = setting.levels.back().frames;
  for (int& count : frames) count = count > 0 ? setting.disk_frames : 0;
  return frames;
}

double CaptureSeconds(const Setting& setting, const std::vector<double>& exposures_s,
                      const Costs& costs) {
  double seconds = 2 * SecondsOf(CalibrationFrames(setting), exposures_s, costs);
  const int series = setting.primaries ? kPrimaries : 1;
  for (const LevelFrames& level : setting.levels) {
    seconds += series * SecondsOf(level.frames, exposures_s, costs);
  }
  for (const ShownFrames& thing : setting.shown) {
    seconds += SecondsOf(thing.frames, exposures_s, costs);
  }
  if (setting.primaries) seconds += SecondsOf(setting.levels.back().frames, exposures_s, costs);
  if (setting.disk_frames > 0) seconds += SecondsOf(DiskFrames(setting), exposures_s, costs);
  return seconds;
}

int FrameCount(const Setting& setting) {
  int count = 2 * Sum(CalibrationFrames(setting));
  const int series = setting.primaries ? kPrimaries : 1;
  for (const LevelFrames& level : setting.levels) count += series * Sum(level.frames);
  for (const ShownFrames& thing : setting.shown) count += Sum(thing.frames);
  if (setting.primaries) count += Sum(setting.levels.back().frames);
  return setting.disk_frames > 0 ? count + Sum(DiskFrames(setting)) : count;
}

std::vector<LevelFrames> EvenLevels(int count, const std::vector<int>& frames) {
  std::vector<LevelFrames> levels;
  for (int i = 0; i < count; ++i) levels.push_back({i / (count - 1.0), frames});
  return levels;
}

}  // namespace eyebox::service
