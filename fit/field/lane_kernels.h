// The inner loops over locations, in kLanes partial sums. Each instruction set compiles its own
// instance and works on kWidth of the lanes at a time, as many as its registers hold; all of them
// do the same operations on a lane in the same order, so that the bits do not depend on it.
// Nothing inline of the standard library may stand here: the linker could take an instance of it
// that a processor without these instructions cannot run.
#ifndef EYEBOX_FIT_FIELD_LANE_KERNELS_H_
#define EYEBOX_FIT_FIELD_LANE_KERNELS_H_

#include <cstddef>
#include <cstdint>

#include "fit/field/kernels.h"

namespace eyebox::fit {

// InstructionSet: kWidth and the vectors Doubles, Words (int64_t), Floats, Bytes (uint8_t) of it.
template <typename InstructionSet>
struct LaneKernels {
  static constexpr int kWidth = InstructionSet::kWidth;
  using Doubles = typename InstructionSet::Doubles;
  using Words = typename InstructionSet::Words;
  using Floats = typename InstructionSet::Floats;
  using Bytes = typename InstructionSet::Bytes;
  static_assert(kBlockLocations % (2 * kLanes) == 0 && kLanes % kWidth == 0 && kLevelTile == 3);

  template <typename Lanes, typename T>
  static Lanes Get(const T* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof(lanes));
    return lanes;
  }

  template <typename T, typename Lanes>
  static void Put(const Lanes& lanes, T* to) {
    __builtin_memcpy(to, &lanes, sizeof(lanes));
  }

  static double Sum(const double* lanes) {
    double sum = 0;
    for (int lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
    return sum;
  }

  // Level by level: rows lie a power of two apart often enough, and lines of 17 of them at once
  // would drive each other out of the caches.
  static bool Load(const FloatBlock& from, int levels, double* block) {
    Words kept[kBlockLocations / kWidth];
    for (int i = 0; i < kBlockLocations; i += kWidth) {
      kept[i / kWidth] = ~Words{};
      if (from.valid == nullptr) continue;
      kept[i / kWidth] = __builtin_convertvector(Get<Bytes>(from.valid + i), Words) != 0;
    }
    Doubles doubt{};  // 0, or NaN once a value was infinite or NaN
    for (int level = 0; level < levels; ++level) {
      const float* row = from.luminance + level * from.stride;
      for (int i = 0; i < kBlockLocations; i += kWidth) {
        __builtin_prefetch(row + i + kBlockLocations);
        const auto value = __builtin_convertvector(Get<Floats>(row + i), Doubles);
        const auto masked =
            reinterpret_cast<Doubles>(reinterpret_cast<Words>(value) & kept[i / kWidth]);
        doubt += masked - masked;
        Put(masked, block + level * kBlockLocations + i);
      }
    }
    bool finite = true;
    for (int lane = 0; lane < kWidth; ++lane) finite &= doubt[lane] == 0;
    return finite;
  }

  static void Accumulate(const double* block, int padded_levels, Moments moments) {
    for (int first = 0; first < kLanes; first += kWidth) {
      double* products = moments.products + first;
      for (int a = 0; a < padded_levels; a += kLevelTile) {
        const double* rows = block + a * kBlockLocations + first;
        for (int k = 0; k < kLevelTile; ++k) {
          AddSums(rows + k * kBlockLocations, moments.sums + (a + k) * kLanes + first);
        }
        for (int b = a; b < padded_levels; b += kLevelTile) {
          AddTile(rows, block + b * kBlockLocations + first, products);
          products += kLevelTile * kLevelTile * kLanes;
        }
      }
    }
  }

  // Fused or not gives the same bits: the product of two floats is exact as a double.
  static void AddProduct(const Doubles& a, const Doubles& b, Doubles& sum) {
#ifdef __FMA__
    for (int lane = 0; lane < kWidth; ++lane) {
      sum[lane] = __builtin_fma(a[lane], b[lane], sum[lane]);
    }
#else
    sum += a * b;
#endif
  }

  static void Add(const Doubles& lanes, double* to) { Put(Get<Doubles>(to) + lanes, to); }

  static void AddSums(const double* row, double* sums) {
    Doubles even{}, odd{};
    for (int i = 0; i < kBlockLocations; i += 2 * kLanes) {
      even += Get<Doubles>(row + i);
      odd += Get<Doubles>(row + i + kLanes);
    }
    Add(even + odd, sums);
  }

  // Products of three levels with three, held in registers over the whole block.
  static void AddTile(const double* a, const double* b, double* products) {
    Doubles p00{}, p01{}, p02{}, p10{}, p11{}, p12{}, p20{}, p21{}, p22{};
    for (int i = 0; i < kBlockLocations; i += kLanes) {
      const auto a0 = Get<Doubles>(a + i);
      const auto a1 = Get<Doubles>(a + kBlockLocations + i);
      const auto a2 = Get<Doubles>(a + 2 * kBlockLocations + i);
      const auto b0 = Get<Doubles>(b + i);
      const auto b1 = Get<Doubles>(b + kBlockLocations + i);
      const auto b2 = Get<Doubles>(b + 2 * kBlockLocations + i);
      AddProduct(a0, b0, p00);
      AddProduct(a0, b1, p01);
      AddProduct(a0, b2, p02);
      AddProduct(a1, b0, p10);
      AddProduct(a1, b1, p11);
      AddProduct(a1, b2, p12);
      AddProduct(a2, b0, p20);
      AddProduct(a2, b1, p21);
      AddProduct(a2, b2, p22);
    }
    const Doubles tile[] = {p00, p01, p02, p10, p11, p12, p20, p21, p22};
    for (int k = 0; k < kLevelTile * kLevelTile; ++k) Add(tile[k], products + k * kLanes);
  }

  static Doubles Root(Doubles lanes) {
    for (int lane = 0; lane < kWidth; ++lane) lanes[lane] = __builtin_sqrt(lanes[lane]);
    return lanes;
  }

  static void FitLines(const double* block, const LineSolver& solver, const LineMaps& maps,
                       SquaredResiduals& squared) {
    double weighted_total[kLanes] = {}, relative_total[kLanes] = {};
    for (int i = 0; i < kBlockLocations; i += kWidth) {
      Doubles gain{}, offset{}, weighted{}, relative{};
      for (int level = 0; level < solver.levels; ++level) {
        const auto value = Get<Doubles>(block + level * kBlockLocations + i);
        gain += solver.to_gain[level] * value;
        offset += solver.to_offset[level] * value;
      }
      for (int level = 0; level < solver.levels; ++level) {
        const auto value = Get<Doubles>(block + level * kBlockLocations + i);
        const Doubles residual = value - (gain * solver.power[level] + offset);
        const Doubles square = residual * residual;
        weighted += solver.weight[level] * square;
        relative += solver.relative_weight[level] * square;
      }
      Add(weighted, weighted_total + i % kLanes);
      Add(relative, relative_total + i % kLanes);
      const Doubles gain_squared = gain * gain;
      const Doubles gain_variance =
          solver.gain_variance * weighted + solver.gain_variance_of_gamma * gain_squared;
      const Doubles offset_variance =
          solver.offset_variance * weighted + solver.offset_variance_of_gamma * gain_squared;
      Put(__builtin_convertvector(gain, Floats), maps.gain + i);
      Put(__builtin_convertvector(offset, Floats), maps.offset + i);
      Put(__builtin_convertvector(Root(gain_variance), Floats), maps.gain_sigma + i);
      Put(__builtin_convertvector(Root(offset_variance), Floats), maps.offset_sigma + i);
    }
    squared.weighted += Sum(weighted_total);
    squared.relative += Sum(relative_total);
  }

  static constexpr Kernels All() { return {Load, Accumulate, FitLines}; }
};

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_FIELD_LANE_KERNELS_H_
