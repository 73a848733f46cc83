// Prints the worst error of every public numeric function over the extreme grid, against 50-digit
// arithmetic, beside what its comment promises. Exit status 1 if a promise is broken.
#include <cstdio>

#include "tests/tools/numerics/single_precision.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

constexpr int kDenseSteps = 4;

bool PrintFunctions() {
  bool all_kept = true;
  std::printf(
      "| function | points | worst | ulp | promised | where |\n|---|---|---|---|---|---|\n");
  for (const Row& row : AllRows({kDenseSteps})) {
    all_kept = all_kept && row.Kept();
    std::printf("| %s | %zu | %.2g %s | %.3g | %.2g%s | %s |\n", row.function.c_str(), row.points,
                row.worst, row.measure == Measure::kRelative ? "relative" : "of scale",
                row.worst_ulp, row.promised, row.Kept() ? "" : " BROKEN", row.where.c_str());
  }
  return all_kept;
}

void PrintSinglePrecision() {
  std::printf(
      "\nWhat single precision loses in the common exponent (%zu locations, no noise), and how the "
      "fit is conditioned\n\n"
      "| gamma | black / white | white cd/m2 | levels | gamma, float32 | gamma, float64 | k, "
      "float32 "
      "| luminance, float32 | condition |\n|---|---|---|---|---|---|---|---|---|\n",
      kFieldLocations);
  for (const PrecisionLoss& loss : MeasurePrecisionLoss(/*dense=*/true)) {
    std::printf("| %g | %g | %g | %d | %.1e | %.1e | %.1e | %.1e | %.3g |\n", loss.gamma,
                loss.black, loss.white_cd_m2, loss.levels, loss.gamma_float32, loss.gamma_float64,
                loss.gain_float32, loss.luminance_float32, loss.condition);
  }
}

}  // namespace
}  // namespace eyebox::numerics

int main() {
  const bool all_kept = eyebox::numerics::PrintFunctions();
  eyebox::numerics::PrintSinglePrecision();
  return all_kept ? 0 : 1;
}
