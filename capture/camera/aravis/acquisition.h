// From triggers to frames: one Aravis camera between opening and loss.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_ACQUISITION_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_ACQUISITION_H_

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/base/frame.h"
#include "capture/camera/aravis/count_planes.h"
#include "capture/camera/aravis/device.h"
#include "capture/camera/aravis/frame_id.h"
#include "capture/camera/aravis/known_state.h"
#include "capture/camera/aravis/stream.h"
#include "capture/camera/camera.h"

namespace eyebox::capture::aravis {

// All of it in one thread. Which call is allowed when, the caller has checked.
// Every call fails with Unavailable once the device is lost.
class Acquisition {
 public:
  // Errors: those of OpenAravisRig.
  static absl::StatusOr<std::unique_ptr<Acquisition>> Open(const AravisOptions& options,
                                                           const Clock* clock);

  const CameraInfo& info() const { return info_; }
  absl::StatusOr<CameraSettings> Configure(const CameraSettings& settings);
  absl::Status Start();
  absl::Status Trigger();
  absl::StatusOr<Frame> NextFrame(std::chrono::milliseconds timeout);
  absl::Status Stop();

 private:
  Acquisition(AravisOptions options, std::unique_ptr<Device> device, const Clock* clock);
  absl::Status Describe();
  absl::Status CheckPresent() const;
  absl::Status Blame(const absl::Status& failure) const;
  absl::StatusOr<Arrival> WaitForArrival(std::chrono::milliseconds timeout);
  Frame FrameOf(Arrival arrival);
  std::optional<int64_t> TakeTriggerTime(uint64_t frame_id);
  void ReadTemperature();

  const AravisOptions options_;
  const std::unique_ptr<Device> device_;
  const Clock* const clock_;
  CameraInfo info_;
  FixedState fixed_;
  CameraSettings settings_;
  FrameIdCounter frame_ids_;
  std::shared_ptr<BufferPool> pool_;
  std::shared_ptr<CountPlanes> planes_;
  std::unique_ptr<Stream> stream_;             // while running
  std::deque<int64_t> trigger_times_ns_;       // of the triggers whose frame is outstanding
  std::optional<uint64_t> previous_frame_id_;  // within this acquisition
  std::optional<double> temperature_degC_;
  int64_t temperature_read_ns_ = 0;
};

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_ACQUISITION_H_
