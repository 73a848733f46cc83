// A three-dimensional colour table and how a texture unit reads it.
#ifndef EYEBOX_OPTICS_RENDER_COLOUR_TABLE_H_
#define EYEBOX_OPTICS_RENDER_COLOUR_TABLE_H_

#include <memory>
#include <vector>

#include "optics/render/rgb.h"

namespace eyebox::optics {

struct ColourTable {
  int size = 0;              // n, at least 2
  std::vector<Rgb> entries;  // [n^3], red fastest, then green, then blue
};
// Pipelines that share a table share its memory.
using SharedTable = std::shared_ptr<const ColourTable>;

// The table whose entry (i, j, k) is (values[i], values[j], values[k]); [n] values.
ColourTable SeparableTable(const std::vector<double>& values);

// Trilinear at `position`, per axis in entries: entry i lies at i. Positions outside [0, n - 1]
// are clamped. `weight_bits` 0 interpolates exactly (to 1e-15 of the largest entry), else weights
// are rounded to 2^-weight_bits, as graphics hardware does with 8. A position that is NaN gives
// NaN.
Rgb SampleTrilinear(const ColourTable& table, const Rgb& position, int weight_bits = 0);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_COLOUR_TABLE_H_
