// Fields of L = k v^gamma + delta with known k and delta at every location.
#ifndef EYEBOX_TESTS_FIT_FIELD_SIMULATED_FIELD_H_
#define EYEBOX_TESTS_FIT_FIELD_SIMULATED_FIELD_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "capture/base/random.h"
#include "fit/field/common_exponent.h"

namespace eyebox::fit {

struct FieldTruth {
  size_t locations = 1000;
  size_t levels = 17;
  double gamma = 2.2;
  double relative_sigma = 0;  // Gaussian, a share of each luminance
  double unit = 1;            // luminance of 1 cd/m2
  uint64_t seed = 1;
};

struct SimulatedField {
  std::vector<double> drives, gains, offsets;
  std::vector<float> luminance;  // [levels, locations]
  std::vector<uint8_t> valid;
  FieldStack Stack() const { return {drives, luminance, valid}; }
};

// Gains from 50 to 150, offsets from 0.2 to 1 cd/m2.
inline SimulatedField SimulateField(const FieldTruth& truth) {
  SimulatedField field;
  RandomStream random({truth.seed});
  for (size_t i = 0; i < truth.locations; ++i) {
    field.gains.push_back(truth.unit * (50 + 100 * random.Uniform()));
    field.offsets.push_back(truth.unit * (0.2 + 0.8 * random.Uniform()));
  }
  for (size_t level = 0; level < truth.levels; ++level) {
    const double drive = static_cast<double>(level) / static_cast<double>(truth.levels - 1);
    field.drives.push_back(drive);
    for (size_t i = 0; i < truth.locations; ++i) {
      const double luminance = field.gains[i] * std::pow(drive, truth.gamma) + field.offsets[i];
      const double gaussian = std::sqrt(-2 * std::log(random.Uniform())) *
                              std::cos(6.283185307179586 * random.Uniform());
      field.luminance.push_back(
          static_cast<float>(luminance * (1 + truth.relative_sigma * gaussian)));
    }
  }
  return field;
}

}  // namespace eyebox::fit

#endif  // EYEBOX_TESTS_FIT_FIELD_SIMULATED_FIELD_H_
