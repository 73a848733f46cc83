// A small forward model of a camera: adds, one by one, the effects that reduction removes.
#ifndef EYEBOX_TESTS_OPTICS_FORWARD_MODEL_H_
#define EYEBOX_TESTS_OPTICS_FORWARD_MODEL_H_

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "capture/base/image.h"
#include "optics/reduce/calibration.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/defect_map.h"
#include "optics/sensor/sensor_range.h"

namespace eyebox::optics {

class ForwardCamera {
 public:
  ForwardCamera(ImageSize size, uint64_t seed)
      : response(size, 1.0F), dark_rate_e_s(size, 0.0F), size_(size), random_(seed) {}

  int bits = 12;
  double gain_dn_per_e = 0.25;
  double read_sigma_dn = 2;
  double bias_dn = 64;
  double exponent = 1;         // of the electrons: 1 is linear
  Image<float> response;       // vignetting and pixel response
  Image<float> dark_rate_e_s;  // dark current

  ImageSize size() const { return size_; }
  SensorRange Range() const { return {bits}; }

  // One frame of light of `rate_e_s` electrons per second (before the response).
  Image<uint16_t> Expose(const Image<float>& rate_e_s, double exposure_s) {
    Image<uint16_t> frame(size_);
    const double full_scale = (1 << bits) - 1;
    for (size_t i = 0; i < frame.pixels().size(); ++i) {
      const double rate = rate_e_s.pixels()[i] * response.pixels()[i] + dark_rate_e_s.pixels()[i];
      const double electrons = std::pow(Poisson(rate * exposure_s), exponent);
      const double dn = gain_dn_per_e * electrons + bias_dn + read_sigma_dn * normal_(random_);
      frame.pixels()[i] = static_cast<uint16_t>(std::clamp(std::round(dn), 0.0, full_scale));
    }
    return frame;
  }

  Stack Record(const Image<float>& rate_e_s, double exposure_s, int frames) {
    FrameStacker stacker({exposure_s, 0}, Range());
    for (int k = 0; k < frames; ++k) {
      const Image<uint16_t> frame = Expose(rate_e_s, exposure_s);
      if (!stacker.Add({frame.pixels(), frame.size()}).ok()) std::abort();
    }
    return *stacker.Finish();
  }

  Stack RecordDark(double exposure_s, int frames) {
    return Record(Image<float>(size_, 0.0F), exposure_s, frames);
  }

  NoiseModel TrueNoise() const {
    NoiseModel noise;
    noise.gain_dn_per_e = gain_dn_per_e;
    noise.read_variance_dn2 = read_sigma_dn * read_sigma_dn;
    noise.bias_dn = bias_dn;
    return noise;
  }

  // Darks of the exposures and the true noise model; no flat.
  Calibration Calibrate(const std::vector<double>& exposures_s, int dark_frames) {
    std::vector<Stack> darks;
    for (const double t : exposures_s) darks.push_back(RecordDark(t, dark_frames));
    Calibration calibration;
    calibration.noise = TrueNoise();
    calibration.defects = *FindHotPixels(darks);
    for (const Stack& dark : darks) {
      calibration.darks.push_back(*MeasureDark(dark, calibration.noise));
    }
    return calibration;
  }

 private:
  double Poisson(double mean) {
    if (mean <= 0) return 0;
    if (mean > 1e6) return mean + std::sqrt(mean) * normal_(random_);
    return static_cast<double>(std::poisson_distribution<long>(mean)(random_));
  }

  ImageSize size_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

struct PullStatistics {
  double mean = 0;
  double rms = 0;
  double count = 0;
};

// Of (value - truth) / sigma over the valid pixels.
template <typename Truth>
PullStatistics Pulls(const MeasuredImage& image, const Truth& truth) {
  PullStatistics pulls;
  double squares = 0;
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    if (image.mask.pixels()[i] != 0) continue;
    const double pull =
        (image.value.pixels()[i] - truth(i)) / std::sqrt(image.variance.pixels()[i]);
    pulls.mean += pull;
    squares += pull * pull;
    ++pulls.count;
  }
  pulls.mean /= pulls.count;
  pulls.rms = std::sqrt(squares / pulls.count);
  return pulls;
}

// No invalid pixel has a number, every valid one has a value and a variance.
inline bool KeepsMaskInvariant(const MeasuredImage& image) {
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    const float value = image.value.pixels()[i];
    const float variance = image.variance.pixels()[i];
    const bool good = image.mask.pixels()[i] != 0
                          ? std::isnan(value) && std::isnan(variance)
                          : std::isfinite(value) && std::isfinite(variance) && variance > 0;
    if (!good) return false;
  }
  return true;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_FORWARD_MODEL_H_
