#include "fit/field/lane_kernels.h"

namespace eyebox::fit {

struct Avx512 {
  static constexpr int kWidth = 8;
  using Doubles = double __attribute__((vector_size(64)));
  using Words = int64_t __attribute__((vector_size(64)));
  using Floats = float __attribute__((vector_size(32)));
  using Bytes = uint8_t __attribute__((vector_size(8)));
};

// Compiled with the flag of these instructions where the compiler has them.
const Kernels* Avx512Kernels() {
#ifdef __AVX512F__
  static constexpr Kernels kKernels = LaneKernels<Avx512>::All();
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("fma") ? &kKernels : nullptr;
#else
  return nullptr;
#endif
}

}  // namespace eyebox::fit
