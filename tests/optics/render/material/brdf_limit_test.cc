// Ends of the scales: smoothness 0 and 1, light and eye at the horizon, facing each other,
// mirrored.
#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "optics/render/material/microfacet.h"
#include "tests/optics/render/material/hemisphere.h"

namespace eyebox::optics {
namespace {

constexpr Rgb kWhite = {1, 1, 1};

std::vector<LitMaterial> WithSmoothness(double smoothness) {
  std::vector<LitMaterial> materials;
  for (const double metallic : {0.0, 1.0}) {
    const Surface surface{kWhite, metallic, {}, smoothness};
    materials.insert(materials.end(), {Standard{surface}, Standard{surface, SmithForm::kShader},
                                       Standard{surface, SmithForm::kExact, true}, UrpLit{surface},
                                       HdrpLit{surface}, HdrpLit{surface, false}});
  }
  materials.push_back(CookTorrance{kWhite, DielectricFresnel{1.5}, 1 - smoothness});
  materials.push_back(Phong{kWhite, kWhite, 1e6});
  materials.push_back(BlinnPhong{kWhite, kWhite, 1});
  return materials;
}

TEST(BrdfLimits, EveryEndOfEveryScaleIsFinite) {
  constexpr std::array kCosines = {0.0, 5e-324, 1e-300, 1e-16, 1e-8, 0.5, 1.0};
  for (const double smoothness : {0.0, 1.0}) {
    for (const LitMaterial& material : WithSmoothness(smoothness)) {
      for (const double n_l : kCosines) {
        for (const double n_v : kCosines) {
          for (const double azimuth : {0.0, 1.0, std::numbers::pi}) {
            const Rgb reflected =
                Reflected(material, DirectionAt(n_l, azimuth), DirectionAt(n_v, 0));
            EXPECT_TRUE(std::isfinite(reflected[0]) && reflected[0] >= 0)
                << NameOf(material) << " " << n_l << " " << n_v << " " << azimuth;
          }
        }
      }
    }
  }
}

TEST(BrdfLimits, LightAgainstTheEyeInThePlaneGivesNothing) {
  const Vec3 east = {1, 0, 0};
  const Vec3 west = {-1, 0, 0};
  const Directions d = DirectionsBetween(kUp, east, west);
  EXPECT_EQ(d.n_h, 1);
  EXPECT_EQ(d.l_h, 0);
  for (const LitMaterial& material : WithSmoothness(0.5)) {
    EXPECT_EQ(Reflected(material, east, west), Rgb{}) << NameOf(material);
  }
}

// Near a smoothness of 1 the lobe would become a mirror; it stays as wide as at the shader's floor.
TEST(BrdfLimits, SmoothnessOfOneHasTheHighlightOfTheFloor) {
  const auto at = [](double smoothness) { return Surface{kWhite, 1, {}, smoothness}; };
  const double standard_floor = 1 - std::sqrt(Standard::kRoughnessFloor);
  const double urp_floor = 1 - std::sqrt(UrpLit::kRoughnessFloor);
  const double hdrp_floor = 1 - std::sqrt(HdrpLit::kRoughnessFloor);
  const double peak = Reflected(Standard{at(1)}, kUp, kUp)[0];
  EXPECT_NEAR(Reflected(Standard{at(standard_floor)}, kUp, kUp)[0] / peak, 1, 1e-12);
  EXPECT_NEAR(peak, 1 / (4 * std::numbers::pi * 0.002 * 0.002), 1e-6 * peak);
  EXPECT_NEAR(Reflected(UrpLit{at(urp_floor)}, kUp, kUp)[0], Reflected(UrpLit{at(1)}, kUp, kUp)[0],
              1e-9);
  EXPECT_NEAR(Reflected(HdrpLit{at(hdrp_floor), false}, kUp, kUp)[0],
              Reflected(HdrpLit{at(1), false}, kUp, kUp)[0], 1e-6);
}

TEST(BrdfLimits, SmoothnessOfZeroHasRoughnessOne) {
  // GGX with roughness 1 is flat: D = 1 / pi at every half vector.
  for (const double n_h : {0.1, 0.5, 1.0}) {
    Directions d;
    d.n_h = n_h;
    d.h_sin2 = 1 - n_h * n_h;
    EXPECT_NEAR(GgxDistribution(d, 1), 1 / std::numbers::pi, 1e-15);
  }
  // ... and white metal seen from above has F = 1, V n.l = 0.5 / (1 + 1 / n.l).
  const Vec3 light = DirectionAt(0.5, 0);
  const double expected = 0.5 / 3 / std::numbers::pi;
  EXPECT_NEAR(Reflected(Standard{Surface{kWhite, 1, {}, 0}}, light, kUp)[0], expected, 1e-15);
}

TEST(BrdfLimits, GrazingEyeSeesTheLimitOfVisibility) {
  EXPECT_EQ(SmithVisibility(0.5, 0, 0.25), 0.5 / 0.25);
  EXPECT_EQ(SmithVisibility(0, 0, 0.25), 0);
  EXPECT_EQ(SmithVisibility(0, 0.5, 0.25), 0);
}

TEST(BrdfLimits, BeckmannVanishesForFacetsOnEdge) {
  Directions d;
  for (const double n_h : {0.0, 1e-320, 1e-100, 1e-10}) {
    d.n_h = n_h;
    d.h_sin2 = 1;
    EXPECT_EQ(BeckmannDistribution(d, 1), 0);
    EXPECT_EQ(BeckmannDistribution(d, 0.002), 0);
  }
}

TEST(FresnelTest, EndsAreThoseOfThePhysics) {
  EXPECT_NEAR(FresnelExact(1, 1.5), 0.04, 1e-16);  // ((n - 1) / (n + 1))^2
  EXPECT_EQ(FresnelExact(0, 1.5), 1);
  EXPECT_EQ(FresnelExact(0.2, 1), 0);        // no boundary
  EXPECT_EQ(FresnelExact(0.5, 1 / 1.5), 1);  // beyond the critical angle
  // Brewster's angle, tan = 1.5: only one polarisation is reflected, ((n^2 - 1) / (n^2 + 1))^2 / 2.
  EXPECT_NEAR(FresnelExact(1 / std::sqrt(3.25), 1.5), 0.5 * std::pow(1.25 / 3.25, 2), 1e-15);
  EXPECT_EQ(FresnelSchlick(1, 0.04), 0.04);
  EXPECT_EQ(FresnelSchlick(0, 0.04), 1);
}

}  // namespace
}  // namespace eyebox::optics
