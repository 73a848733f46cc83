#include "capture/camera/v4l2/frame_gate.h"

#include <algorithm>
#include <cmath>

namespace eyebox::capture {

void FrameGate::Abandon() {
  if (!triggers_.empty()) triggers_.pop_front();
}

uint64_t FrameGate::LostAnswers(uint32_t steps, int64_t start_ns, int64_t earliest_ns) const {
  if (steps <= 1) return 0;
  const uint32_t lost = steps - 1;
  if (start_ns <= last_->start_ns) return lost;  // no order in time: all of them may have counted
  // Lost frame k of 1 .. steps - 1 began at last + k (start - last) / steps.
  const double first = std::ceil(static_cast<double>(earliest_ns - last_->start_ns) * steps /
                                 static_cast<double>(start_ns - last_->start_ns));
  if (first > lost) return 0;
  return lost - static_cast<uint64_t>(std::max(first, 1.0)) + 1;
}

std::optional<AdmittedFrame> FrameGate::Admit(uint32_t sequence, int64_t start_ns) {
  std::optional<AdmittedFrame> admitted;
  if (!triggers_.empty()) {
    const int64_t earliest_ns = std::max(settled_ns_, triggers_.front());
    const uint32_t steps = last_ ? sequence - last_->sequence : 1;
    frame_id_ += LostAnswers(steps, start_ns, earliest_ns);
    if (start_ns >= earliest_ns) {
      // A sequence number that stands still does not pass for the next frame.
      if (steps > 0) ++frame_id_;
      admitted = {.frame_id = frame_id_, .trigger_time_ns = triggers_.front()};
      triggers_.pop_front();
    }
  }
  last_ = {.sequence = sequence, .start_ns = start_ns};
  return admitted;
}

}  // namespace eyebox::capture
