// Adds up the frames of one stimulus taken with one setting, frame by frame, in one pass.
#ifndef EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_
#define EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/sensor/sensor_range.h"

namespace eyebox::optics {

// What a dark must share with its light.
struct Setting {
  double exposure_s = 0;
  double gain_db = 0;
};

// Exposures are equal to 1 part in 1e4 (cameras round to a clock of their own), gains to 1e-3 dB.
bool SameSetting(const Setting& a, const Setting& b);
std::string Describe(const Setting& setting);

// The mean of `frames` frames. Arrays are [height, width].
struct Stack {
  Setting setting;
  SensorRange range;
  int frames = 0;
  Image<float> mean_dn;
  Image<uint8_t> saturated_count;  // frames at or above saturation, 255 means 255 or more

  ImageSize size() const { return mean_dn.size(); }
};

// Not thread-safe. Memory: five bytes a pixel, whatever the number of frames.
class FrameStacker {
 public:
  FrameStacker(const Setting& setting, const SensorRange& range)
      : setting_(setting), range_(range) {}

  // The first frame decides the size. Errors: InvalidArgument (another size, an empty frame, a
  // count above 2^bits - 1, more than 65536 frames); the frame is then not added.
  absl::Status Add(const FrameView& frame);

  int frames() const { return frames_; }

  // Leaves the stacker empty, ready for other frames of the same setting.
  // Errors: FailedPrecondition (no frame was added).
  absl::StatusOr<Stack> Finish();

 private:
  Setting setting_;
  SensorRange range_;
  int frames_ = 0;
  Image<uint32_t> sum_dn_;  // exact: 65536 frames of 16 bits fit
  Image<uint8_t> saturated_count_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_
