// Takes settled frames of a rig, and remembers what it said of its settings.
#ifndef EYEBOX_SERVICE_PREFLIGHT_FRAME_TAKER_H_
#define EYEBOX_SERVICE_PREFLIGHT_FRAME_TAKER_H_

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/camera/rig.h"
#include "service/preflight/read_back.h"

namespace eyebox::service {

using Counts = std::vector<uint16_t>;  // of one frame, DN, row by row

class FrameTaker {
 public:
  // `rig` must outlive this. `settle_frames` are dropped after every change.
  FrameTaker(capture::Rig& rig, int settle_frames) : rig_(rig), settle_frames_(settle_frames) {}

  // Errors: those of the presenter.
  absl::Status ShowDark();
  absl::Status ShowGrey(double drive);

  // The first `count` frames after the change to this exposure, or those after settling.
  // Errors: those of Camera; Unavailable (three frames in a row were incomplete).
  absl::StatusOr<std::vector<Counts>> TakeFirst(double exposure_s, int count);
  absl::StatusOr<std::vector<Counts>> TakeSettled(double exposure_s, int count);
  // Sets the camera and reads it back without exposing.
  absl::Status Set(double exposure_s);
  absl::Status Stop() { return rig_.camera->Stop(); }

  const std::vector<ReadBack>& read_backs() const { return read_backs_; }
  const capture::CameraInfo& info() const { return rig_.camera->Info(); }

 private:
  absl::StatusOr<Counts> TakeOne(double exposure_s);
  absl::StatusOr<Frame> NextFrame(double exposure_s);

  capture::Rig& rig_;
  const int settle_frames_;
  std::vector<ReadBack> read_backs_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_FRAME_TAKER_H_
