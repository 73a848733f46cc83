// The map of standard uncertainties that goes with a map of variances.
#ifndef EYEBOX_SERVICE_RESULTS_SIGMA_MAP_H_
#define EYEBOX_SERVICE_RESULTS_SIGMA_MAP_H_

#include <cmath>

#include "capture/base/image.h"

namespace eyebox::service {

// [height, width]; NaN stays NaN.
inline Image<float> SigmaMap(const Image<float>& variance) {
  Image<float> sigma(variance.size());
  for (size_t i = 0; i < sigma.pixels().size(); ++i) {
    sigma.pixels()[i] = std::sqrt(variance.pixels()[i]);
  }
  return sigma;
}

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_SIGMA_MAP_H_
