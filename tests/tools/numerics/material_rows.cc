// Factors of the reflection models, to grazing angles and to the sharpest highlights.
#include <algorithm>
#include <cmath>
#include <vector>

#include "optics/render/material/cook_torrance.h"
#include "optics/render/material/microfacet.h"
#include "optics/render/material/standard.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

using optics::Directions;

const Digits50& Pi50() {
  static const Digits50 pi = 4 * atan(Digits50(1));
  return pi;
}

// From grazing to perpendicular; both sides of either.
std::vector<double> Cosines(Density density) {
  std::vector<double> cosines = {1e-300, 1, std::nextafter(1.0, 0.0)};
  for (const double c : LogSteps(1e-12, 0.5, 7 * density.steps)) {
    cosines.insert(cosines.end(), {c, 1 - c});
  }
  return cosines;
}

std::vector<double> Roughnesses(Density density) {
  std::vector<double> roughnesses = LogSteps(0.002, 1, 6 * density.steps);
  roughnesses.insert(roughnesses.end(), {1e-6, 1.0 / 1024});
  return roughnesses;
}

void AddDistributions(Density density, std::vector<Row>& rows) {
  WorstCase ggx("GgxDistribution", 1e-15);
  WorstCase beckmann("BeckmannDistribution", 1e-12);
  for (const double roughness : Roughnesses(density)) {
    const Digits50 a2 = Digits50(roughness) * roughness;
    for (const double sine2 : LogSteps(1e-18, 1, 40 * density.steps)) {
      Directions d;
      d.h_sin2 = sine2;
      d.n_h = std::sqrt(1 - sine2);
      const Digits50 cos2 = Digits50(d.n_h) * d.n_h;
      const Digits50 spread = sine2 + a2 * cos2;
      ggx.Compare(optics::GgxDistribution(d, roughness), a2 / (Pi50() * spread * spread),
                  {{"roughness", roughness}, {"sin2", sine2}});
      const Digits50 exact =
          cos2 == 0 ? Digits50(0)
                    : exp(Digits50(-sine2 / (cos2 * a2))) / (Pi50() * a2 * cos2 * cos2);
      if (exact > 0 && exact < 1e-290) continue;
      beckmann.Compare(optics::BeckmannDistribution(d, roughness), exact,
                       {{"roughness", roughness}, {"sin2", sine2}});
    }
  }
  rows.push_back(ggx.row());
  rows.push_back(beckmann.row());
}

Digits50 Smith50(const Digits50& n_l, const Digits50& n_v, const Digits50& roughness) {
  const Digits50 a2 = roughness * roughness;
  const Digits50 view = sqrt(Digits50(a2 + (1 - a2) * n_v * n_v));
  const Digits50 light = sqrt(Digits50(a2 + (1 - a2) * n_l * n_l));
  return n_l / (2 * (n_l * view + n_v * light));
}

void AddVisibilities(Density density, std::vector<Row>& rows) {
  WorstCase smith("SmithVisibility", 1e-15);
  WorstCase approximate("SmithVisibilityApproximate", 1e-15);
  WorstCase cavity("CavityVisibility", 1e-15);
  for (const double n_l : Cosines(density)) {
    for (const double n_v : Cosines(density)) {
      for (const double r : Roughnesses(density)) {
        smith.Compare(optics::SmithVisibility(n_l, n_v, r), Smith50(n_l, n_v, r),
                      {{"n.l", n_l}, {"n.v", n_v}, {"roughness", r}});
        const Digits50 l(n_l), v(n_v), a(r);
        const Digits50 sum = l * (v * (1 - a) + a) + v * (l * (1 - a) + a) + Digits50(1e-5);
        approximate.Compare(optics::SmithVisibilityApproximate(n_l, n_v, r), l / (2 * sum),
                            {{"n.l", n_l}, {"n.v", n_v}, {"roughness", r}});
      }
      Directions d;
      d.n_l = n_l;
      d.n_v = n_v;
      d.n_h = 0.9;
      d.l_h = std::max(0.3, 0.5 * n_l);
      const Digits50 masked = 2 * Digits50(d.n_h) / d.l_h;
      const Digits50 lowest =
          std::min({Digits50(1), Digits50(masked * n_v), Digits50(masked * n_l)});
      cavity.Compare(optics::CavityVisibility(d), lowest / (4 * Digits50(n_v)),
                     {{"n.l", n_l}, {"n.v", n_v}});
    }
  }
  rows.push_back(smith.row());
  rows.push_back(approximate.row());
  rows.push_back(cavity.row());
}

Digits50 Fresnel50(const Digits50& u, const Digits50& index) {
  const Digits50 b2 = index * index + u * u - 1;
  if (b2 <= 0) return index == 1 ? 0 : 1;
  const Digits50 b = sqrt(b2);
  const Digits50 s = (b - u) / (b + u);
  const Digits50 p = (u * (b + u) - 1) / (u * (b - u) + 1);
  return s * s * (1 + p * p) / 2;
}

void AddFresnel(Density density, std::vector<Row>& rows) {
  WorstCase exact("FresnelExact", 1e-14);
  WorstCase schlick("FresnelSchlick", 1e-15);
  for (const double index : {0.4, 0.667, 1 - 1e-9, 1 + 1e-9, 1.0001, 1.33, 1.5, 2.4, 10.0}) {
    std::vector<double> cosines = Cosines(density);
    if (index < 1) {  // both sides of the critical angle
      const double critical = std::sqrt((1 - index) * (1 + index));
      for (const double step : LogSteps(1e-15, 1e-3, 7)) cosines.push_back(critical * (1 + step));
      for (const double step : LogSteps(1e-15, 1e-3, 7)) cosines.push_back(critical * (1 - step));
    }
    for (const double u : cosines) {
      exact.Compare(optics::FresnelExact(u, index), Fresnel50(u, index),
                    {{"index - 1", index - 1}, {"u", u}});
    }
  }
  for (const double f0 : {0.0, 0.02, 0.04, 0.5, 1.0}) {
    for (const double u : Cosines(density)) {
      schlick.Compare(optics::FresnelSchlick(u, f0),
                      f0 + (1 - Digits50(f0)) * pow(1 - Digits50(u), 5), {{"f0", f0}, {"u", u}});
    }
  }
  rows.push_back(exact.row());
  rows.push_back(schlick.row());
}

// A light and an eye in the plane of the normal; the angles of h follow.
Directions InPlane(double light_rad, double view_rad) {
  const auto at = [](double angle) { return optics::Vec3{std::sin(angle), 0, std::cos(angle)}; };
  return optics::DirectionsBetween({0, 0, 1}, at(light_rad), at(view_rad));
}

void AddDirections(Density density, std::vector<Row>& rows) {
  WorstCase cosine("DirectionsBetween, n.h", 1e-15, Measure::kOfScale);
  WorstCase sine("DirectionsBetween, |n x h|^2", 1e-15, Measure::kOfScale);
  for (const double light : LogSteps(1e-9, 1.5707963, 12 * density.steps)) {
    for (const double view : LogSteps(1e-9, 1.5707963, 12 * density.steps)) {
      const Directions d = InPlane(light, -view);
      const Digits50 x = Digits50(std::sin(light)) + std::sin(-view);
      const Digits50 z = Digits50(std::cos(light)) + std::cos(-view);
      const Digits50 square = x * x + z * z;
      cosine.Compare(d.n_h, z / sqrt(square), {{"light rad", light}, {"view rad", view}});
      // Of the sine itself: the rounding of unit vectors moves it by their last digit.
      const auto sin2 = static_cast<double>(x * x / square);
      sine.Compare(d.h_sin2, x * x / square, {{"light rad", light}, {"view rad", view}},
                   std::max(std::sqrt(sin2), 1e-150));
    }
  }
  rows.push_back(cosine.row());
  rows.push_back(sine.row());
}

void AddModels(Density density, std::vector<Row>& rows) {
  WorstCase standard("Standard::Reflected, metal", 1e-14);
  WorstCase cook("CookTorrance::Reflected, highlight", 1e-12);
  for (const double light : LogSteps(1e-6, 1.5707963, 10 * density.steps)) {
    for (const double view : LogSteps(1e-6, 1.5707963, 10 * density.steps)) {
      for (const double smoothness : {0.0, 0.3, 0.9, 1.0}) {
        const Directions d = InPlane(light, view / 2 - light / 3);
        if (!d.InFront()) continue;
        optics::Standard metal;
        metal.surface.metallic = 1;
        metal.surface.smoothness = smoothness;
        const double r = std::max((1 - smoothness) * (1 - smoothness), 0.002);
        const Digits50 a2 = Digits50(r) * r;
        const Digits50 cos2 = Digits50(d.n_h) * d.n_h;
        const Digits50 spread = d.h_sin2 + a2 * cos2;
        standard.Compare(metal.Reflected(d)[0],
                         a2 / (Pi50() * spread * spread) * Smith50(d.n_l, d.n_v, r),
                         {{"light rad", light}, {"n.v", d.n_v}, {"smoothness", smoothness}});
        const optics::CookTorrance facets{{0, 0, 0}, optics::DielectricFresnel{1.5}, r};
        const Digits50 density50 =
            exp(Digits50(-d.h_sin2 / (cos2 * a2))) / (Pi50() * a2 * cos2 * cos2);
        const Digits50 masked = 2 * Digits50(d.n_h) / d.l_h;
        const Digits50 lowest =
            std::min({Digits50(1), Digits50(masked * d.n_v), Digits50(masked * d.n_l)});
        const Digits50 exact = density50 * lowest / Digits50(d.n_v) * Fresnel50(d.l_h, 1.5);
        if (exact < 1e-280) continue;
        cook.Compare(facets.Reflected(d)[0], exact,
                     {{"light rad", light}, {"n.v", d.n_v}, {"roughness", r}});
      }
    }
  }
  rows.push_back(standard.row());
  rows.push_back(cook.row());
}

}  // namespace

void AddMaterialRows(Density density, std::vector<Row>& rows) {
  AddDistributions(density, rows);
  AddVisibilities(density, rows);
  AddFresnel(density, rows);
  AddDirections(density, rows);
  AddModels(density, rows);
}

}  // namespace eyebox::numerics
