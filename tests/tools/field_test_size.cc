// Prints how often the F test of one exponent against one a region rejects, where one is true (its
// size, 5 % wanted) and where the exponent runs over the field (its power).
#include <cstdio>
#include <cstdlib>

#include "tests/fit/field/gradient_field.h"

namespace {

using eyebox::fit::GradientTruth;
using eyebox::fit::RejectedShare;

void Row(const char* words, const GradientTruth& truth, int replicates, bool with_cutoff) {
  eyebox::fit::SharedExponentOptions options;
  options.with_cutoff = with_cutoff;
  const double share = RejectedShare(truth, replicates, options);
  std::printf("%-44s %4zu x %2zu, %d regions: %6.2f %% +- %.2f %% of %d\n", words, truth.locations,
              truth.levels, truth.regions, 100 * share,
              100 * std::sqrt(share * (1 - share) / replicates), replicates);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int replicates = argc > 1 ? std::atoi(argv[1]) : 4000;
  Row("size", {.seed = 1000000}, replicates, false);
  Row("size, 20 % of the readings masked", {.masked_share = 0.2, .seed = 2000000}, replicates,
      false);
  Row("size, 4 locations a region", {.locations = 12, .seed = 3000000}, replicates, false);
  Row("size, 17 levels, 9 regions", {.locations = 90, .levels = 17, .regions = 9, .seed = 4000000},
      replicates, false);
  Row("size, gamma and cutoff", {.cutoff = 0.05, .seed = 5000000}, replicates / 4, true);
  const int fewer = replicates / 4;
  Row("power, gradient 3 %, noise 1 %", {.relative_gradient = 0.03, .seed = 6000000}, fewer, false);
  Row("power, gradient 3 %, 17 levels, 9 regions",
      {.locations = 90, .levels = 17, .regions = 9, .relative_gradient = 0.03, .seed = 7000000},
      fewer, false);
  Row("power, gradient 3 %, 20 % masked",
      {.relative_gradient = 0.03, .masked_share = 0.2, .seed = 8000000}, fewer, false);
  return 0;
}
