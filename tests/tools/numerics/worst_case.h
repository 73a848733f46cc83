// The largest error of one function over a grid, beside what its comment promises.
#ifndef EYEBOX_TESTS_TOOLS_NUMERICS_WORST_CASE_H_
#define EYEBOX_TESTS_TOOLS_NUMERICS_WORST_CASE_H_

#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/numerics/digits.h"

namespace eyebox::numerics {

enum class Measure {
  kRelative,  // of the exact value
  kOfScale,   // of the scale that is given with each comparison
};

struct Row {
  std::string function;
  Measure measure = Measure::kRelative;
  double promised = 0;
  double worst = 0;      // infinite where a value is not finite and should be, or the other way
  double worst_ulp = 0;  // the same error in units of the last place of the exact value
  std::string where;     // the arguments of the worst
  size_t points = 0;

  bool Kept() const { return worst <= promised; }
};

using Arguments = std::initializer_list<std::pair<const char*, double>>;

class WorstCase {
 public:
  WorstCase(std::string function, double promised, Measure measure = Measure::kRelative);

  // Against |exact|, or |scale| for kOfScale. Where the exact value is below the smallest normal
  // double, whose neighbours below have fewer digits, the value must be below it too.
  void Compare(double value, const Digits50& exact, Arguments arguments, double scale = 1);
  const Row& row() const { return row_; }

 private:
  Row row_;
};

// How dense the grid is: 1 is quick enough for every test run.
struct Density {
  int steps = 1;
};

// Every function below adds the rows of one folder.
void AddActivationRows(Density density, std::vector<Row>& rows);
void AddGradientRows(Density density, std::vector<Row>& rows);
void AddRenderRows(Density density, std::vector<Row>& rows);
void AddTableRows(Density density, std::vector<Row>& rows);
void AddMaterialRows(Density density, std::vector<Row>& rows);
void AddGeometryRows(Density density, std::vector<Row>& rows);
void AddScatterRows(Density density, std::vector<Row>& rows);
void AddDistributionRows(Density density, std::vector<Row>& rows);
void AddVarianceRows(Density density, std::vector<Row>& rows);

std::vector<Row> AllRows(Density density);

// `count` values from `low` to `high`, evenly in their logarithm.
std::vector<double> LogSteps(double low, double high, int count);

}  // namespace eyebox::numerics

#endif  // EYEBOX_TESTS_TOOLS_NUMERICS_WORST_CASE_H_
