// Work on one block of locations, in the fastest form that this processor has.
#ifndef EYEBOX_FIT_FIELD_KERNELS_H_
#define EYEBOX_FIT_FIELD_KERNELS_H_

#include <cstddef>
#include <cstdint>

namespace eyebox::fit {

constexpr int kLanes = 8;
constexpr int kBlockLocations = 128;  // x 17 levels of doubles stay in the first cache
constexpr int kLevelTile = 3;  // blocks have a multiple of this many levels, zeros at the end

// [levels, kBlockLocations], rows `stride` apart; `valid` [kBlockLocations] or null: all.
struct FloatBlock {
  const float* luminance = nullptr;
  size_t stride = 0;
  const uint8_t* valid = nullptr;
};

// Sums over locations, each spread over kLanes partial sums: of the levels [padded levels, kLanes]
// and of their products [tiles, kLevelTile, kLevelTile, kLanes]; tiles on and above the diagonal,
// row by row.
struct Moments {
  double* sums = nullptr;
  double* products = nullptr;
};

// k = to_gain . y, delta = to_offset . y, residual y - k power - delta; each array [levels].
// Variance of k = gain_variance (weighted sum of squares) + gain_variance_of_gamma k^2.
struct LineSolver {
  int levels = 0;
  const double* to_gain = nullptr;
  const double* to_offset = nullptr;
  const double* power = nullptr;
  const double* weight = nullptr;
  const double* relative_weight = nullptr;
  double gain_variance = 0;
  double gain_variance_of_gamma = 0;
  double offset_variance = 0;
  double offset_variance_of_gamma = 0;
};

// [kBlockLocations] each, written.
struct LineMaps {
  float* gain = nullptr;
  float* gain_sigma = nullptr;
  float* offset = nullptr;
  float* offset_sigma = nullptr;
};

struct SquaredResiduals {
  double weighted = 0;
  double relative = 0;
};

struct Kernels {
  // Widens into `block` [levels, kBlockLocations]; a location that is not valid becomes 0.
  // False if a valid value is not finite.
  bool (*load)(const FloatBlock& from, int levels, double* block);
  void (*accumulate)(const double* block, int padded_levels, Moments moments);
  // A location of zeros gives zeros.
  void (*fit_lines)(const double* block, const LineSolver& solver, const LineMaps& maps,
                    SquaredResiduals& squared);
};

const Kernels& BestKernels();

// For the test that all give the same bits; null where this processor or build has none.
const Kernels* GenericKernels();
const Kernels* Avx2Kernels();
const Kernels* Avx512Kernels();

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_KERNELS_H_
