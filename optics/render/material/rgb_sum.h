// Arithmetic of light on colours: sums, products channel by channel, scaling.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_RGB_SUM_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_RGB_SUM_H_

#include <algorithm>

#include "optics/render/rgb.h"

namespace eyebox::optics {

inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Rgb operator*(const Rgb& a, const Rgb& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline Rgb operator*(double s, const Rgb& a) { return {s * a[0], s * a[1], s * a[2]}; }

inline bool IsBlack(const Rgb& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }
inline double Largest(const Rgb& a) { return std::max({a[0], a[1], a[2]}); }

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_RGB_SUM_H_
