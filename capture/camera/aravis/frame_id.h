// Frame ids that never wrap.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_FRAME_ID_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_FRAME_ID_H_

#include <cstdint>

namespace eyebox::capture::aravis {

enum class FrameIdWidth {
  k16Bit,  // GigE Vision block ids: 1 to 65535, then 1 again; 0 is never used
  k64Bit,  // GigE Vision 2 extended ids, USB3 Vision
};

// Follows the ids of one camera. A gap stays a gap, a frame that came late gets its own place.
class FrameIdCounter {
 public:
  explicit FrameIdCounter(FrameIdWidth width) : width_(width) {}

  // Between two acquisitions some cameras count from the start again: whatever comes next comes
  // after everything before.
  void Restart() { restarted_ = true; }

  uint64_t Unwrap(uint64_t device_id) {
    const bool first = last_ == 0 && last_device_id_ == 0;
    if (first) {
      last_ = device_id;
    } else if (restarted_) {
      last_ += ForwardStep(device_id);
    } else {
      const uint64_t forward = ForwardStep(device_id);
      const bool backward =
          width_ == FrameIdWidth::k16Bit ? forward > kIds / 2 : device_id < last_device_id_;
      if (backward) return last_ - BackwardStep(device_id, forward);
      last_ += forward;
    }
    restarted_ = false;
    last_device_id_ = device_id;
    return last_;
  }

 private:
  static constexpr uint64_t kIds = 65535;

  uint64_t ForwardStep(uint64_t device_id) const {
    if (width_ == FrameIdWidth::k64Bit) {
      if (!restarted_) return device_id - last_device_id_;
      return device_id > last_device_id_ ? device_id - last_device_id_ : device_id + 1;
    }
    const uint64_t step = (device_id + kIds - last_device_id_) % kIds;
    return step == 0 && restarted_ ? kIds : step;
  }

  uint64_t BackwardStep(uint64_t device_id, uint64_t forward) const {
    return width_ == FrameIdWidth::k16Bit ? kIds - forward : last_device_id_ - device_id;
  }

  FrameIdWidth width_;
  uint64_t last_ = 0;
  uint64_t last_device_id_ = 0;
  bool restarted_ = false;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_FRAME_ID_H_
