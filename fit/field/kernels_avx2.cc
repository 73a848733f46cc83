#include "fit/field/lane_kernels.h"

namespace eyebox::fit {

struct Avx2 {
  static constexpr int kWidth = 4;
  using Doubles = double __attribute__((vector_size(32)));
  using Words = int64_t __attribute__((vector_size(32)));
  using Floats = float __attribute__((vector_size(16)));
  using Bytes = uint8_t __attribute__((vector_size(4)));
};

// Compiled with the flag of these instructions where the compiler has them.
const Kernels* Avx2Kernels() {
#ifdef __AVX2__
  static constexpr Kernels kKernels = LaneKernels<Avx2>::All();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &kKernels : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace eyebox::fit
