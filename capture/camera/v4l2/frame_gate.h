// Turns a free-running camera into one that answers triggers: which of its frames count.
#ifndef EYEBOX_CAPTURE_CAMERA_V4L2_FRAME_GATE_H_
#define EYEBOX_CAPTURE_CAMERA_V4L2_FRAME_GATE_H_

#include <cstdint>
#include <deque>
#include <optional>

namespace eyebox::capture {

struct AdmittedFrame {
  uint64_t frame_id = 0;
  int64_t trigger_time_ns = 0;
};

// A trigger marks a moment; the next frame that began after it answers it. Frames that nobody asked
// for are passed over and take no part in the numbering: frame ids count answers, and a gap in them
// is a frame that would have been one and was lost. All times are CLOCK_MONOTONIC.
class FrameGate {
 public:
  // No frame that began before `settled_ns` counts: it may show the exposure of before.
  explicit FrameGate(int64_t settled_ns) : settled_ns_(settled_ns) {}

  void Trigger(int64_t time_ns) { triggers_.push_back(time_ns); }
  // Gives the oldest trigger up.
  void Abandon();

  // To be called for every frame in the order of the driver. `start_ns` is when its exposure began;
  // `sequence` counts all frames of the device, modulo 2^32. Empty: the frame answers no trigger.
  // Lost frames are taken to have begun at equal distances between their neighbours.
  std::optional<AdmittedFrame> Admit(uint32_t sequence, int64_t start_ns);

 private:
  uint64_t LostAnswers(uint32_t steps, int64_t start_ns, int64_t earliest_ns) const;

  struct Seen {
    uint32_t sequence;
    int64_t start_ns;
  };

  const int64_t settled_ns_;
  std::deque<int64_t> triggers_;
  std::optional<Seen> last_;
  uint64_t frame_id_ = 0;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_CAMERA_V4L2_FRAME_GATE_H_
