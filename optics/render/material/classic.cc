#include "optics/render/material/classic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

Rgb WithHighlight(const Rgb& diffuse, const Rgb& specular, double n_l, double cosine,
                  double exponent) {
  Rgb reflected = (n_l / std::numbers::pi) * diffuse;
  if (IsBlack(specular) || cosine <= 0) return reflected;
  return reflected + (std::pow(std::min(cosine, 1.0), exponent) / std::numbers::pi) * specular;
}

}  // namespace

Rgb Lambert::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  return (d.n_l / std::numbers::pi) * diffuse;
}

Rgb Phong::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  return WithHighlight(diffuse, specular, d.n_l, d.v_r, exponent);
}

Rgb BlinnPhong::Reflected(const Directions& d) const {
  if (!d.InFront()) return {};
  return WithHighlight(diffuse, specular, d.n_l, d.n_h, exponent);
}

}  // namespace eyebox::optics
