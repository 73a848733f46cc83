// Photon transfer: gain and read noise from the recording itself, never from a constant.
#ifndef EYEBOX_OPTICS_SENSOR_PHOTON_TRANSFER_H_
#define EYEBOX_OPTICS_SENSOR_PHOTON_TRANSFER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/capture_spec.h"
#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/noise_model.h"

namespace eyebox::optics {

struct PhotonTransferOptions {
  int bins = 64;                     // of the signal, from 0 to saturation
  double fitted_fraction = 0.7;      // of saturation; EMVA 1288 fits the lower 70 %
  size_t pixels_per_pair = 1 << 20;  // larger frames are sampled evenly
  int colour_period_px = 2;          // same-colour neighbours; 2 suits a Bayer mosaic and grey
};

// Variance of one frame against signal above bias, both averaged over one bin of one pair.
struct PhotonTransferPoint {
  double signal_dn = 0;
  double variance_dn2 = 0;
  double degrees_of_freedom = 0;
};

// Streams frames capture by capture. Captures of two or more frames give temporal points (half the
// variance of the difference of two frames, so that fixed patterns cancel, and each bin's mean
// difference is removed, so that drift does too). Single frames of light give spatial points (per
// tile, half the variance of the difference of same-colour neighbours; the median of the tiles of
// a bin), which are used only where no pair of light or flat frames exists.
// Saturated, clipped and defective pixels take no part. Not thread-safe.
// Memory: two frames and the points.
class PhotonTransfer {
 public:
  // `bias` is the stack of the shortest dark exposure (its mean is subtracted pixel by pixel);
  // `defects` is [height, width], not 0 where defective, or empty.
  PhotonTransfer(Stack bias, Image<uint8_t> defects, const PhotonTransferOptions& options = {});

  // Frames added from now on belong to one capture: one stimulus, one setting.
  void BeginCapture(FrameKind kind);
  // Errors: InvalidArgument (size differs from the bias).
  absl::Status AddFrame(const FrameView& frame);

  // Weighted straight line through the points: variance = read + quantisation + K signal.
  // Errors: FailedPrecondition (no darks in pairs, no light, too small a range of signal: says
  // what to record).
  absl::StatusOr<NoiseModel> Fit();

  const std::vector<PhotonTransferPoint>& temporal_points() const { return temporal_; }

 private:
  void EndCapture();
  void AddPair(const FrameView& first, const FrameView& second);
  void AddSingle(const FrameView& frame);

  Stack bias_;
  Image<uint8_t> defects_;
  PhotonTransferOptions options_;
  double bias_median_dn_ = 0;
  FrameKind kind_ = FrameKind::kDark;
  int frames_in_capture_ = 0;
  Image<uint16_t> previous_;
  bool pending_ = false;
  bool saw_dark_pair_ = false;
  bool saw_light_pair_ = false;
  std::vector<PhotonTransferPoint> temporal_;
  std::vector<std::vector<float>> tile_variances_;  // [bin][tile], capped
  std::vector<double> tile_signal_sums_;            // [bin]
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_PHOTON_TRANSFER_H_
