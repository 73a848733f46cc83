#include "capture/camera/sim/sensor.h"

#include <algorithm>
#include <cmath>

namespace eyebox::capture {
namespace {

// Keys of the streams, so that another share of hot pixels leaves the other maps as they were.
enum PatternStream : uint64_t { kResponse = 1, kDarkCurrent, kOffset, kHotPixels };

Image<double> GaussianMap(ImageSize size, double mean, double sigma, uint64_t seed,
                          PatternStream stream) {
  NoiseSource noise({seed, stream});
  Image<double> map(size);
  for (double& value : map.pixels()) value = mean + sigma * noise.Gaussian();
  return map;
}

void AddHotPixels(const SensorParameters& sensor, uint64_t seed, Image<double>& current_e_s) {
  NoiseSource noise({seed, kHotPixels});
  const double log_ratio = std::log(sensor.hot_current_max_e_s / sensor.hot_current_min_e_s);
  for (double& value : current_e_s.pixels()) {
    const bool hot = noise.Uniform() < sensor.hot_pixel_share;
    const double hot_e_s = sensor.hot_current_min_e_s * std::exp(log_ratio * noise.Uniform());
    if (hot) value += hot_e_s;
  }
}

}  // namespace

FixedPattern MakeFixedPattern(const SensorParameters& sensor, uint64_t seed) {
  FixedPattern pattern{
      .response = GaussianMap(sensor.size, 1, sensor.photo_response_nonuniformity, seed, kResponse),
      .dark_current_e_s = GaussianMap(sensor.size, sensor.dark_current_e_s,
                                      sensor.dark_current_e_s * sensor.dark_current_nonuniformity,
                                      seed, kDarkCurrent),
      .offset_e = GaussianMap(sensor.size, 0, sensor.offset_nonuniformity_e, seed, kOffset)};
  for (double& value : pattern.dark_current_e_s.pixels()) value = std::max(value, 0.0);
  AddHotPixels(sensor, seed, pattern.dark_current_e_s);
  return pattern;
}

std::vector<uint16_t> Expose(const SensorParameters& sensor, const FixedPattern& pattern,
                             const Image<double>& photo_rate_e_s, const CameraSettings& settings,
                             NoiseSource& noise) {
  const double gain_dn_per_e = sensor.gain_dn_per_e * std::pow(10, settings.gain_db / 20);
  const double full_scale_dn = (1 << sensor.bits) - 1;
  const auto light_e_s = photo_rate_e_s.pixels();
  const auto dark_e_s = pattern.dark_current_e_s.pixels();
  const auto offset_e = pattern.offset_e.pixels();
  std::vector<uint16_t> counts_dn(light_e_s.size());
  for (size_t i = 0; i < counts_dn.size(); ++i) {
    const double expected_e = (light_e_s[i] + dark_e_s[i]) * settings.exposure_s;
    const double collected_e =
        std::min(static_cast<double>(noise.Poisson(expected_e)), sensor.full_well_e);
    const double read_e = offset_e[i] + sensor.read_noise_e * noise.Gaussian();
    const double signal_dn = gain_dn_per_e * (collected_e + read_e) + sensor.bias_dn;
    counts_dn[i] =
        static_cast<uint16_t>(std::clamp(std::floor(signal_dn + 0.5), 0.0, full_scale_dn));
  }
  return counts_dn;
}

}  // namespace eyebox::capture
