#include "fit/field/kernels.h"

namespace eyebox::fit {

const Kernels& BestKernels() {
  static const Kernels& best = Avx512Kernels() != nullptr ? *Avx512Kernels()
                               : Avx2Kernels() != nullptr ? *Avx2Kernels()
                                                          : *GenericKernels();
  return best;
}

}  // namespace eyebox::fit
