// Adds up the frames of one stimulus taken with one setting, frame by frame, in one pass.
#ifndef EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_
#define EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_

#include <cstdint>
#include <optional>
#include <span>
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

// The outermost counts of each pixel, DN, [height, width]; of one frame both highest and lowest are
// that frame's, the second ones 0 and 65535.
struct Extremes {
  Image<uint16_t> highest;
  Image<uint16_t> second_highest;
  Image<uint16_t> second_lowest;
  Image<uint16_t> lowest;
};

// The mean of `frames` frames. Arrays are [height, width].
struct Stack {
  Setting setting;
  SensorRange range;
  int frames = 0;
  Image<float> mean_dn;
  Image<uint8_t> saturated_count;  // frames at or above saturation, 255 means 255 or more
  // Frames that mean_dn leaves out, see clip_stack.h; empty: none anywhere.
  Image<uint8_t> rejected_count = {};
  std::optional<Extremes> extremes = std::nullopt;  // where the stacker kept them
  // Of the sensor, mean over the frames; where all of them tell it.
  std::optional<double> temperature_degC = std::nullopt;

  ImageSize size() const { return mean_dn.size(); }
};

// Not thread-safe; adds a large frame on all processors. Memory: three bytes a pixel, seven from
// the frame on that 16 bits cannot hold the sum of (the 17th of 12 bits), whatever their number.
class FrameStacker {
 public:
  // keep_extremes: for ClipStack, eight bytes a pixel more.
  FrameStacker(const Setting& setting, const SensorRange& range, bool keep_extremes = false)
      : setting_(setting), range_(range), keep_extremes_(keep_extremes) {}

  // The first frame decides the size. Errors: InvalidArgument (another size, an empty frame, a
  // count above 2^bits - 1, more than 65536 frames); the frame is then not added. After a count
  // above 2^bits - 1 the stacker is empty.
  absl::Status Add(const FrameView& frame, std::optional<double> temperature_deg_c = {});

  int frames() const { return frames_; }

  // Leaves the stacker empty, ready for other frames of the same setting.
  // Errors: FailedPrecondition (no frame was added).
  absl::StatusOr<Stack> Finish();

 private:
  void Begin(ImageSize size);
  int PartialCapacity() const;
  void FlushPartial();
  // Returns every bit that is set in any pixel.
  uint16_t AddPieces(std::span<const uint16_t> pixels_dn);

  Setting setting_;
  SensorRange range_;
  bool keep_extremes_ = false;
  int frames_ = 0;
  int temperatures_ = 0;  // frames that told theirs
  double temperature_sum_ = 0;
  // Sums are exact. Frames go into 16 bits as long as those hold them, which takes half the way to
  // memory and back, then into 32 bits, which hold 65536 frames of 16 bits; no pixels until then.
  Image<uint16_t> partial_dn_;
  int partial_frames_ = 0;
  Image<uint32_t> sum_dn_;
  std::optional<Extremes> extremes_;
  Image<uint8_t> saturated_count_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_FRAME_STACKER_H_
