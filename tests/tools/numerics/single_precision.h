// What the single precision of a field stack costs the common exponent.
#ifndef EYEBOX_TESTS_TOOLS_NUMERICS_SINGLE_PRECISION_H_
#define EYEBOX_TESTS_TOOLS_NUMERICS_SINGLE_PRECISION_H_

#include <cstddef>
#include <vector>

namespace eyebox::numerics {

inline constexpr size_t kFieldLocations = 64;

// One field of known truth, stored in single and in double precision. Errors are relative to the
// truth; infinite where the fit failed.
struct PrecisionLoss {
  double gamma = 0;
  double black = 0;  // delta / k
  double white_cd_m2 = 0;
  int levels = 0;
  double gamma_float32 = 0;      // of FitCommonExponent
  double gamma_float64 = 0;      // of the same search on products of doubles
  double gain_float32 = 0;       // largest of a location's k
  double luminance_float32 = 0;  // largest over locations and drives, of the fitted luminance
  double condition = 0;          // of one location's gain, offset and gamma, see ConditionNumber()
};

// gamma 0.3 to 8, black 0 to 10 %, luminance 1e-4 to 1e5 cd/m2, 5 to 65 levels.
std::vector<PrecisionLoss> MeasurePrecisionLoss(bool dense);

}  // namespace eyebox::numerics

#endif  // EYEBOX_TESTS_TOOLS_NUMERICS_SINGLE_PRECISION_H_
