// Directions and places in a scene, in Unity's left-handed axes: x right, y up, z forward.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_VEC3_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_VEC3_H_

#include <cmath>

namespace eyebox::optics {

struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }

inline double Dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double Length(const Vec3& a) {
  const double square = Dot(a, a);
  // The square of what is very small or large leaves the range of doubles.
  if (square > 1e-280 && square < 1e280) return std::sqrt(square);
  return std::hypot(a.x, a.y, a.z);
}

// `a` must not be of length 0.
inline Vec3 Normalised(const Vec3& a) { return (1 / Length(a)) * a; }

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_VEC3_H_
