#include "fit/field/lane_kernels.h"

namespace eyebox::fit {

struct AnyProcessor {
  static constexpr int kWidth = 2;
  using Doubles = double __attribute__((vector_size(16)));
  using Words = int64_t __attribute__((vector_size(16)));
  using Floats = float __attribute__((vector_size(8)));
  using Bytes = uint8_t __attribute__((vector_size(2)));
};

const Kernels* GenericKernels() {
  static constexpr Kernels kKernels = LaneKernels<AnyProcessor>::All();
  return &kKernels;
}

}  // namespace eyebox::fit
