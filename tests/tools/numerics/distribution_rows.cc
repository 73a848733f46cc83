// Tails of the distributions behind the tests of significance.
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>

#include "fit/field/f_distribution.h"
#include "optics/uniformity/chi_square.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {

void AddDistributionRows(Density density, std::vector<Row>& rows) {
  WorstCase f_tail("FTail", 1e-7);
  for (const double numerator : {1.0, 7.0, 100.0}) {
    for (const double denominator : {1.0, 30.0, 5000.0}) {
      for (const double f : LogSteps(1e-6, 30, 6 * density.steps)) {
        const Digits50 total = denominator + Digits50(numerator) * f;
        const Digits50 exact = boost::math::ibeta(
            Digits50(denominator / 2), Digits50(numerator / 2), Digits50(denominator / total));
        if (exact < 1e-250) continue;
        f_tail.Compare(fit::FTail(f, numerator, denominator), exact,
                       {{"f", f}, {"freedom", numerator}, {"and", denominator}});
      }
    }
  }
  WorstCase chi_square("ChiSquareSurvival", 1e-12);
  for (const double freedom : {1.0, 2.5, 30.0, 1000.0}) {
    for (const double ratio : LogSteps(1e-6, 20, 8 * density.steps)) {
      const double chi2 = ratio * freedom;
      const Digits50 exact = boost::math::gamma_q(Digits50(freedom) / 2, Digits50(chi2) / 2);
      if (exact < 1e-300) continue;
      chi_square.Compare(optics::ChiSquareSurvival(chi2, freedom), exact,
                         {{"chi2", chi2}, {"freedom", freedom}});
    }
  }
  rows.push_back(f_tail.row());
  rows.push_back(chi_square.row());
}

}  // namespace eyebox::numerics
