// Luminance images with noise that they know of.
#ifndef EYEBOX_TESTS_OPTICS_SCATTER_LUMINANCE_IMAGES_H_
#define EYEBOX_TESTS_OPTICS_SCATTER_LUMINANCE_IMAGES_H_

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "capture/base/random.h"
#include "optics/photometry/luminance_image.h"

namespace eyebox::optics {

inline double Gaussian(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.Uniform()));
  return radius * std::cos(6.283185307179586 * random.Uniform());
}

// Variance sigma^2 + photon_gain * truth per pixel.
inline LuminanceImage WithNoise(const Image<float>& truth, double sigma, double photon_gain,
                                uint64_t seed) {
  RandomStream random({seed});
  LuminanceImage luminance;
  luminance.absolute = true;
  luminance.image = MakeMeasuredImage(truth.size(), "cd/m2");
  for (size_t i = 0; i < truth.pixels().size(); ++i) {
    const double light = std::max<double>(truth.pixels()[i], 0);
    const double variance = sigma * sigma + photon_gain * light;
    luminance.image.variance.pixels()[i] = static_cast<float>(variance);
    luminance.image.value.pixels()[i] =
        static_cast<float>(truth.pixels()[i] + std::sqrt(variance) * Gaussian(random));
  }
  return luminance;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_SCATTER_LUMINANCE_IMAGES_H_
