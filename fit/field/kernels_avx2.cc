#include "fit/field/lane_kernels.h"

namespace eyebox::fit {

struct Avx2;

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
