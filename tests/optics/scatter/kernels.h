// Kernels that the tests of scatter share.
#ifndef EYEBOX_TESTS_OPTICS_SCATTER_KERNELS_H_
#define EYEBOX_TESTS_OPTICS_SCATTER_KERNELS_H_

#include <vector>

#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

// Every shape, mild to extreme.
inline std::vector<ScatterKernel> AllKernels() {
  std::vector<ScatterKernel> kernels;
  for (const CoreShape core : {CoreShape::kGaussian, CoreShape::kDisk}) {
    for (const TailShape tail : {TailShape::kMoffat, TailShape::kPowerLaw}) {
      for (const double exponent : {1.0, 2.0, 2.0 + 1e-12, 3.3}) {
        kernels.push_back({core, tail, 0.17, 0.3, 0.8, exponent, 0.05, 20});
      }
      kernels.push_back({core, tail, 0.17, 0, 0.8, 3, 0, 20});
      kernels.push_back({core, tail, 1e-4, 0.9, 2e-3, 2.5, 0.05, 60});
    }
  }
  return kernels;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_SCATTER_KERNELS_H_
