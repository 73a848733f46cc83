#include "fit/field/lane_kernels.h"

namespace eyebox::fit {

struct AnyProcessor;

const Kernels* GenericKernels() {
  static constexpr Kernels kKernels = LaneKernels<AnyProcessor>::All();
  return &kKernels;
}

}  // namespace eyebox::fit
