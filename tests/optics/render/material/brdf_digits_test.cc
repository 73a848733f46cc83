// The models against their published formulas in 50 digits, written down another way: angles and
// the shadowing function Lambda in place of cosines and visibility (Kyselka sections 2.4, 3.2.2).
#include <gtest/gtest.h>

#include <array>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_dec_float.hpp>

#include "optics/render/material/microfacet.h"
#include "tests/optics/render/material/hemisphere.h"

namespace eyebox::optics {
namespace {

using Real = boost::multiprecision::cpp_dec_float_50;
const Real kPi = boost::math::constants::pi<Real>();

struct Point {
  double light_deg;
  double view_deg;
  double azimuth_deg;  // between light and eye
  double albedo;
  double metallic;
  double smoothness;
};

constexpr std::array kPoints = {
    Point{0, 0, 0, 0.5, 0, 0.5},        Point{30, 45, 180, 0.8, 0, 0.5},
    Point{60, 20, 90, 1, 0.25, 0},      Point{75, 75, 180, 0.3, 1, 0.7},
    Point{10, 80, 45, 0.6, 0.5, 0.9},   Point{85, 5, 120, 0.9, 0, 0.2},
    Point{45, 45, 180, 0.18, 0.1, 0.8}, Point{89, 89, 179, 1, 0, 0.3},
    Point{50, 30, 10, 0.05, 0.9, 0.6},  Point{20, 60, 170, 0.7, 0.75, 0.4}};

Real Radians(double degrees) { return Real(degrees) * kPi / 180; }

struct Angles {
  Real light, view;        // from the normal
  Real tan2_half, cos_lh;  // tangent^2 of the facet's tilt, cosine between light and half vector
};

Angles AnglesOf(const Point& p) {
  Angles a;
  a.light = Radians(p.light_deg);
  a.view = Radians(p.view_deg);
  const Real x = sin(a.light) + sin(a.view) * cos(Radians(p.azimuth_deg));
  const Real z = sin(a.view) * sin(Radians(p.azimuth_deg));
  const Real y = cos(a.light) + cos(a.view);
  a.tan2_half = (x * x + z * z) / (y * y);
  const Real length = sqrt(x * x + y * y + z * z);
  a.cos_lh = (sin(a.light) * x + cos(a.light) * y) / length;
  return a;
}

Real Lambda(const Real& angle, const Real& alpha) {
  if (angle == 0) return 0;
  const Real a = 1 / (alpha * tan(angle));
  return (sqrt(1 + 1 / (a * a)) - 1) / 2;
}

Real Schlick(const Real& f0, const Real& u) { return f0 + (1 - f0) * pow(1 - u, 5); }

Real StandardExact(const Point& p) {
  const Angles a = AnglesOf(p);
  const Real rough = 1 - Real(p.smoothness);
  const Real alpha = rough * rough;
  const Real cos4 = 1 / pow(1 + a.tan2_half, 2);
  const Real d = alpha * alpha / (kPi * cos4 * pow(alpha * alpha + a.tan2_half, 2));
  const Real g = 1 / (1 + Lambda(a.light, alpha) + Lambda(a.view, alpha));
  const Real f0 = Real(0.04) + (Real(p.albedo) - Real(0.04)) * Real(p.metallic);
  const Real f90 = Real(1) / 2 + 2 * rough * a.cos_lh * a.cos_lh;
  const Real disney =
      (1 + (f90 - 1) * pow(1 - cos(a.light), 5)) * (1 + (f90 - 1) * pow(1 - cos(a.view), 5));
  const Real diffuse = Real(p.albedo) * (1 - Real(0.04)) * (1 - Real(p.metallic)) / kPi * disney;
  const Real specular = Schlick(f0, a.cos_lh) * d * g / (4 * cos(a.light) * cos(a.view));
  return (diffuse + specular) * cos(a.light);
}

Real CookTorranceExact(const Point& p, double index) {
  const Angles a = AnglesOf(p);
  const Real m = 1 - Real(p.smoothness);
  const Real cos_h = 1 / sqrt(1 + a.tan2_half);
  const Real d = exp(-a.tan2_half / (m * m)) / (m * m * pow(cos_h, 4));
  Real g = 1;
  for (const Real& angle : {a.light, a.view}) {
    g = std::min<Real>(g, 2 * cos_h * cos(angle) / a.cos_lh);
  }
  // Fresnel from Snell's law and the two polarisations.
  const Real cos_t = sqrt(1 - (1 - a.cos_lh * a.cos_lh) / (Real(index) * Real(index)));
  const Real s = (a.cos_lh - index * cos_t) / (a.cos_lh + index * cos_t);
  const Real q = (index * a.cos_lh - cos_t) / (index * a.cos_lh + cos_t);
  const Real f = (s * s + q * q) / 2;
  const Real specular = f / kPi * d * g / (cos(a.light) * cos(a.view));
  return (Real(p.albedo) / kPi + specular) * cos(a.light);
}

double FromLibrary(const LitMaterial& material, const Point& p) {
  const auto direction = [](const Real& angle, const Real& azimuth) {
    return Vec3{static_cast<double>(sin(angle) * cos(azimuth)), static_cast<double>(cos(angle)),
                static_cast<double>(sin(angle) * sin(azimuth))};
  };
  return Reflected(material, direction(Radians(p.light_deg), 0),
                   direction(Radians(p.view_deg), Radians(p.azimuth_deg)))[0];
}

TEST(StandardDigits, TenPointsAgreeWithFiftyDigits) {
  double worst = 0;
  for (const Point& p : kPoints) {
    const Rgb grey = {p.albedo, p.albedo, p.albedo};
    const Standard standard{Surface{grey, p.metallic, {}, p.smoothness}};
    const Real exact = StandardExact(p);
    const double error = static_cast<double>(abs(Real(FromLibrary(standard, p)) / exact - 1));
    EXPECT_LT(error, 2e-13) << p.light_deg << " " << p.view_deg << " " << p.smoothness;
    worst = std::max(worst, error);
  }
  RecordProperty("worst_relative", std::to_string(worst * 1e15) + "e-15");
}

TEST(CookTorranceDigits, TenPointsAgreeWithFiftyDigits) {
  for (const Point& p : kPoints) {
    const Rgb grey = {p.albedo, p.albedo, p.albedo};
    const CookTorrance material{grey, DielectricFresnel{1.5}, 1 - p.smoothness};
    const Real exact = CookTorranceExact(p, 1.5);
    EXPECT_LT(static_cast<double>(abs(Real(FromLibrary(material, p)) / exact - 1)), 2e-13)
        << p.light_deg << " " << p.view_deg << " " << p.smoothness;
  }
}

// Half vectors within 1e-6 of the normal: 1 - (n.h)^2 from n.h alone would have 4 digits left.
TEST(GgxDigits, SharpHighlightsKeepTheirDigits) {
  for (const double offset : {1e-9, 1e-6, 1e-3}) {
    const Vec3 light = DirectionAt(std::cos(0.3), 0);
    const double view_angle = 0.3 - 2 * offset;
    const Vec3 view = {-std::sin(view_angle), std::cos(view_angle), 0};
    const Real alpha = Real(Standard::kRoughnessFloor);
    const Real tan2 = pow(tan(Real(offset)), 2);
    const Real exact = alpha * alpha * pow(1 + tan2, 2) / (kPi * pow(alpha * alpha + tan2, 2));
    const Directions d = DirectionsBetween(kUp, light, view);
    const double found = GgxDistribution(d, Standard::kRoughnessFloor);
    EXPECT_NEAR(static_cast<double>(Real(found) / exact), 1, 1e-11) << offset;
  }
}

}  // namespace
}  // namespace eyebox::optics
