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
#include "optics/sensor/tile_variance.h"
#include "optics/sensor/variance_line.h"

namespace eyebox::optics {

struct PhotonTransferOptions {
  int bins = 64;                     // of the signal, from 0 to the fitted fraction of saturation
  double fitted_fraction = 0.7;      // of saturation; EMVA 1288 fits the lower 70 %
  size_t pixels_per_pair = 1 << 20;  // larger frames are sampled evenly
  int colour_period_px = 2;          // same-colour neighbours; 2 suits a Bayer mosaic and grey
};

// Streams frames capture by capture. Captures of two or more frames give temporal points (half the
// variance of the difference of two frames, so that fixed patterns cancel, and each bin's mean
// difference is removed, so that drift does too). Single frames of light give spatial points (see
// TileVariances), which are used only where no pair of light or flat frames exists.
// Saturated, clipped and defective pixels take no part. Not thread-safe.
// Memory: three frames and the bins, whatever the length of the recording.
class PhotonTransfer {
 public:
  // `bias` is the stack of the shortest dark exposure (its mean is subtracted pixel by pixel);
  // `defects` is [height, width], not 0 where defective, or empty.
  PhotonTransfer(Stack bias, Image<uint8_t> defects, const PhotonTransferOptions& options = {});

  // Frames added from now on belong to one capture: one stimulus, one setting.
  void BeginCapture(FrameKind kind);
  // Errors: InvalidArgument (size differs from the bias).
  absl::Status AddFrame(const FrameView& frame);

  // Straight line through the points: variance = read + quantisation + K signal. What is found
  // below the variance of quantisation counts as no read noise. Errors: FailedPrecondition (no
  // light, too small a range of signal for K to 20 %: says what to record).
  absl::StatusOr<NoiseModel> Fit();

  // Bins that take part: those of pairs of frames, or of single frames if there were no pairs of
  // light; the darks' first, if they are not clipped at 0 DN.
  std::vector<PhotonTransferPoint> Points() const;

 private:
  // Sums over the pairs of one bin; variances of one straight line may be averaged over signals.
  struct Bin {
    double freedom = 0;
    double freedom_variance = 0;
    double freedom_signal = 0;
  };

  void EndCapture();
  void AddPair(const FrameView& first, const FrameView& second);
  size_t BinOf(double signal_dn) const;

  Stack bias_;
  Image<uint8_t> defects_;
  PhotonTransferOptions options_;
  double bias_median_dn_;
  double upper_signal_dn_;
  FrameKind kind_ = FrameKind::kDark;
  Image<uint16_t> previous_;
  int frames_in_capture_ = 0;
  bool saw_light_pair_ = false;
  Bin dark_;
  std::vector<Bin> light_;
  TileVariances tiles_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_PHOTON_TRANSFER_H_
