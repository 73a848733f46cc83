// Calibration and stacks from frames that are at hand, wherever they come from.
#ifndef EYEBOX_SERVICE_PLANNER_HELD_FRAMES_H_
#define EYEBOX_SERVICE_PLANNER_HELD_FRAMES_H_

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "service/planner/frame_source.h"

namespace eyebox::service {

// What a frame of one scene is told by, whatever its exposure.
std::vector<uint64_t> SceneKeyOf(const CaptureSpec& spec);
// All of a key in one number.
uint64_t MixedKey(const std::vector<uint64_t>& key);

CaptureSpec DarkScene();

class HeldFrames : public FrameSource {
 public:
  // Darks, defects, noise and flat, as `eyebox run` learns them.
  absl::StatusOr<const optics::Calibration*> CalibrationOf(int frames) override;
  absl::StatusOr<std::vector<optics::Stack>> Take(const Stimulus& stimulus,
                                                  const std::vector<int>& frames) override;

 protected:
  using Counts = std::span<const uint16_t>;  // of one frame, DN, [height * width]

  // `count` frames of the scene in ExposuresS()[exposure], the same first ones for every count.
  // Valid while this lives. Errors: FailedPrecondition (there are not so many).
  virtual absl::StatusOr<std::vector<Counts>> FramesOf(const CaptureSpec& scene, size_t exposure,
                                                       int count) = 0;
  virtual CaptureSpec FlatScene() const = 0;
  virtual optics::KnownLuminance StatedFlat() const = 0;
  virtual double GainDb() const { return 0; }

  const std::map<int, optics::Calibration>& calibrations() const { return calibrations_; }

 private:
  absl::StatusOr<std::vector<optics::Stack>> Bracket(const CaptureSpec& scene,
                                                     const std::vector<int>& frames);
  absl::StatusOr<optics::NoiseModel> MeasureNoise(const optics::Stack& shortest_dark, int frames,
                                                  const optics::DefectMap& defects);
  absl::StatusOr<optics::Calibration> Calibrate(int frames);

  std::map<int, optics::Calibration> calibrations_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_HELD_FRAMES_H_
