// What every fit reports of each of its parameters.
#ifndef EYEBOX_FIT_BASE_PARAMETER_H_
#define EYEBOX_FIT_BASE_PARAMETER_H_

#include <string>

namespace eyebox::fit {

struct Parameter {
  std::string name;  // "gamma", "minimum_luminance", ...
  double value = 0;
  double sigma = 0;  // standard uncertainty, same unit; 0 only for a parameter that was held
  std::string unit;  // "1", "cd/m2", ...
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_BASE_PARAMETER_H_
