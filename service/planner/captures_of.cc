#include <string>
#include <utility>

#include "capture/plan.h"
#include "service/planner/plan_measurement.h"

namespace eyebox::service {
namespace {

constexpr uint64_t kOrderSeed = 1;
constexpr const char* kPrimaryNames[] = {"red", "green", "blue"};

class PlanBuilder {
 public:
  explicit PlanBuilder(const Pilot& pilot) : pilot_(pilot) {}

  void Add(CaptureSpec spec, const std::vector<int>& frames) {
    spec.gain_db = pilot_.noise.gain_db;
    for (size_t k = 0; k < frames.size(); ++k) {
      if (frames[k] == 0) continue;
      spec.exposure_s = pilot_.exposures_s[k];
      spec.repeats = frames[k];
      plan_.captures.push_back(spec);
    }
  }

  void AddLevels(const std::vector<LevelFrames>& levels, const std::string& series,
                 const DriveRgb& channels) {
    // In random order, so that drift does not look like a slope.
    for (const int i : capture::ShuffledLevels(static_cast<int>(levels.size()), kOrderSeed)) {
      const LevelFrames& level = levels[static_cast<size_t>(i)];
      CaptureSpec spec;
      spec.series = series;
      spec.level_id = i;
      spec.stimulus.drive =
          DriveRgb{level.drive * channels[0], level.drive * channels[1], level.drive * channels[2]};
      Add(spec, level.frames);
    }
  }

  void AddShown(const Setting& setting, const Need& need) {
    for (size_t i = 0; i < setting.shown.size(); ++i) {
      CaptureSpec spec;
      // A series each, by which it is chosen to be read: a colour has no level.
      spec.series = "scene-" + std::to_string(i + 1);
      if (need.disk_deg > 0) spec.stimulus.pattern = StimulusPattern::kDisk;
      spec.stimulus.diameter_deg = need.disk_deg;
      spec.stimulus.drive = setting.shown[i].drive;
      Add(spec, setting.shown[i].frames);
    }
  }

  CapturePlan Finish() { return std::move(plan_); }

 private:
  const Pilot& pilot_;
  CapturePlan plan_;
};

}  // namespace

CapturePlan CapturesOf(const Setting& setting, const Pilot& pilot, const Need& need) {
  PlanBuilder builder(pilot);
  std::vector<int> calibration;
  for (const bool used : ExposuresInUse(setting)) {
    calibration.push_back(used ? setting.calibration_frames : 0);
  }
  CaptureSpec dark;
  dark.kind = FrameKind::kDark;
  builder.Add(dark, calibration);
  CaptureSpec flat;
  flat.kind = FrameKind::kFlat;
  flat.luminance_cd_m2 = pilot.flat_luminance;
  flat.luminance_relative_sigma = pilot.flat_relative_sigma;
  builder.Add(flat, calibration);
  if (!setting.primaries) {
    builder.AddLevels(setting.levels, "", {1, 1, 1});
  } else {
    for (size_t c = 0; c < 3; ++c) {
      DriveRgb channels = {0, 0, 0};
      channels[c] = 1;
      builder.AddLevels(setting.levels, kPrimaryNames[c], channels);
    }
    builder.AddLevels({setting.levels.back()}, "", {1, 1, 1});
  }
  builder.AddShown(setting, need);
  if (setting.disk_frames > 0) {
    CaptureSpec disk;
    disk.series = capture::kGlareSeries;
    disk.stimulus.pattern = StimulusPattern::kDisk;
    disk.stimulus.diameter_deg = need.disk_deg;
    disk.stimulus.drive = DriveRgb{1, 1, 1};
    builder.Add(disk, DiskFrames(setting));
  }
  return builder.Finish();
}

}  // namespace eyebox::service
