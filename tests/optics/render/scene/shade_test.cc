#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "optics/render/scene/scene.h"
#include "optics/render/srgb.h"

namespace eyebox::optics {
namespace {

using std::numbers::pi;
constexpr Rgb kWhite = {1, 1, 1};

Patch PatchWith(const Vec3& normal, const Vec3& view) { return {0, {}, normal, view}; }

Rgb ShadeOnly(const Scene& scene, const Patch& patch = {}) { return Shade(Prepare(scene), patch); }

DirectionalLight Frontal(double intensity, const Rgb& colour = kWhite) {
  return {colour, intensity, {0, 0, -1}};
}

Vec3 Slanted(double degrees) {
  return {std::sin(degrees * pi / 180), 0, -std::cos(degrees * pi / 180)};
}

// HDRP model, eq 3 by hand: s(0.5) = ((0.5 + 0.055) / 1.055)^2.4 = 0.21404, s(0.04) = 0.04 / 12.92.
TEST(UnlitTest, IsTheDecodedColourWhateverLightAndExposure) {
  Scene scene;
  scene.settings.exposure_ev = 5;
  scene.materials = {Unlit{{0.5, 0.04, 1}}};
  scene.lights = {Frontal(100), AmbientLight{}};
  const Rgb u = ShadeOnly(scene);
  EXPECT_NEAR(u[0], 0.2140411, 1e-7);
  EXPECT_NEAR(u[1], 0.04 / 12.92, 1e-16);
  EXPECT_EQ(u[2], 1);
}

// HDRP model, eq 2 by hand: c = 0.822, m = 0.5, i_d = 3, d = (1, 0.5, 0), n.l = 0.5, i_a = 0.4,
// a = (0.2, 1, 2), e = 1. Red: 0.822 0.2140411 (3 0.5 / pi + 0.08) / 2 = 0.0490407; green: 0.822
// 0.2140411 (3 0.2140411 0.5 / pi + 0.4) / 2 = 0.0441787; blue: 0.822 0.2140411 0.8 / 2.
TEST(HdrpLambertTest, FollowsThePublishedEquation) {
  Scene scene;
  scene.settings.exposure_ev = 1;
  scene.materials = {LitMaterial(Lambert{{0.5, 0.5, 0.5}})};
  scene.lights = {Frontal(3, {1, 0.5, 0}), AmbientLight{{0.2, 1, 2}, 0.4}};
  const Rgb u = ShadeOnly(scene, PatchWith(Slanted(60), Slanted(60)));
  EXPECT_NEAR(u[0], 0.0490407, 1e-7);
  EXPECT_NEAR(u[1], 0.0441787, 1e-7);
  EXPECT_NEAR(u[2], 0.0703768, 1e-7);
}

TEST(HdrpLambertTest, LightFromBehindLeavesTheAmbientTerm) {
  Scene scene;
  scene.materials = {LitMaterial(Lambert{kWhite})};
  scene.lights = {DirectionalLight{kWhite, 10, {0, 0, 1}}, AmbientLight{kWhite, 0.5}};
  EXPECT_NEAR(ShadeOnly(scene)[0], 0.822 * 0.5, 1e-16);
}

double BuiltIn(Renderer renderer, double m, double degrees) {
  Scene scene;
  scene.settings.renderer = renderer;
  scene.materials = {LitMaterial(Lambert{{m, m, m}})};
  scene.lights = {Frontal(1)};
  const double u = ShadeOnly(scene, PatchWith(Slanted(degrees), Slanted(degrees)))[0];
  return renderer == Renderer::kBuiltInGamma ? u : LinearToSrgb(u);
}

// Murray, Patel and Wiedenmann, fig 2a: in Gamma mode the value is the cosine.
TEST(BuiltInTest, GammaModeIsColourTimesCosine) {
  for (const double degrees : {0.0, 25.0, 60.0, 85.0}) {
    EXPECT_NEAR(BuiltIn(Renderer::kBuiltInGamma, 0.6, degrees), 0.6 * std::cos(degrees * pi / 180),
                1e-15);
  }
  EXPECT_EQ(BuiltIn(Renderer::kBuiltInGamma, 0.6, 100), 0);
}

// Fig 2b: in Linear mode the sRGB function makes the cosine out of it.
TEST(BuiltInTest, LinearModeCompressesTheCosine) {
  for (const double degrees : {0.0, 25.0, 60.0, 85.0}) {
    const double v = BuiltIn(Renderer::kBuiltInLinear, 1, degrees);
    EXPECT_NEAR(SrgbToLinear(v), std::cos(degrees * pi / 180), 1e-15);
  }
}

// Fig 2c: as a function of the colour, under a frontal light of 1, the modes do not differ.
TEST(BuiltInTest, ModesAgreeOnTheColour) {
  for (const double m : {0.0, 0.03, 0.2, 0.5, 1.0}) {
    EXPECT_NEAR(BuiltIn(Renderer::kBuiltInLinear, m, 0), m, 1e-14);
    EXPECT_NEAR(BuiltIn(Renderer::kBuiltInGamma, m, 0), m, 1e-15);
  }
}

TEST(BuiltInTest, LinearModeDecodesIntensityWithTheColour) {
  Scene scene;
  scene.settings.renderer = Renderer::kBuiltInLinear;
  scene.materials = {LitMaterial(Lambert{kWhite})};
  scene.lights = {Frontal(0.5, {1, 0.5, 0.5})};
  EXPECT_NEAR(ShadeOnly(scene)[0], SrgbToLinear(0.5), 1e-15);
  scene.settings.renderer = Renderer::kUrp;  // where intensity multiplies the decoded colour
  EXPECT_NEAR(ShadeOnly(scene)[1], 0.5 * SrgbToLinear(0.5), 1e-15);
}

TEST(ShadeTest, LightsAddUp) {
  Scene scene;
  const Surface surface{{0.8, 0.4, 0.2}, 0.3, {}, 0.6};
  scene.materials = {LitMaterial(HdrpLit{surface})};
  const std::vector<Light> lights = {Frontal(2), PointLight{kWhite, 3, {0.5, 1, -2}, 10},
                                     SpotLight{{kWhite, 5, {0, 0, -3}, 0}, {0, 0, 1}, 40, 0.5},
                                     AmbientLight{kWhite, 0.2}};
  const Patch patch = PatchWith(Slanted(10), Slanted(-30));
  double sum = 0;
  for (const Light& light : lights) {
    scene.lights = {light};
    const double alone = ShadeOnly(scene, patch)[0];
    EXPECT_GT(alone, 0);
    sum += alone;
  }
  scene.lights = lights;
  EXPECT_NEAR(ShadeOnly(scene, patch)[0], sum, 1e-14);
}

TEST(ShadeTest, SaysWhatItUsed) {
  Scene scene;
  scene.materials = {Unlit{}, LitMaterial(Lambert{}),
                     LitMaterial(HdrpLit{Surface{kWhite, 1, {}, 0.5}})};
  scene.lights = {Frontal(1),
                  Frontal(0),
                  DirectionalLight{kWhite, 1, {0, 0, 1}},
                  PointLight{kWhite, 1, {0, 0, -5}, 2},
                  AmbientLight{kWhite, 0},
                  AmbientLight{kWhite, 1}};
  const PreparedScene prepared = Prepare(scene);
  using enum LightUse;
  const TermsUsed unlit = ExplainShading(scene, prepared, Patch{0, {}});
  EXPECT_EQ(unlit.lights, std::vector<LightUse>(6, kUnlit));
  EXPECT_FALSE(unlit.lobes.diffuse || unlit.lobes.specular || unlit.ambient || unlit.view);
  const TermsUsed matte = ExplainShading(scene, prepared, Patch{1, {}});
  EXPECT_EQ(matte.lights, (std::vector{kShaded, kBlack, kBehind, kOutOfReach, kBlack, kShaded}));
  EXPECT_TRUE(matte.lobes.diffuse && matte.ambient);
  EXPECT_FALSE(matte.lobes.specular || matte.view);
  const TermsUsed metal = ExplainShading(scene, prepared, Patch{2, {}});
  EXPECT_TRUE(metal.lobes.specular && metal.view);
  EXPECT_FALSE(metal.lobes.diffuse);
}

}  // namespace
}  // namespace eyebox::optics
