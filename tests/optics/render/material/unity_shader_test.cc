// Values of the models worked by hand from the published formulas, and the property table.
#include <gtest/gtest.h>

#include <numbers>

#include "optics/render/material/property_table.h"
#include "tests/optics/render/material/hemisphere.h"

namespace eyebox::optics {
namespace {

using std::numbers::pi;
constexpr Rgb kBlack = {};
constexpr Rgb kWhite = {1, 1, 1};

Vec3 At(double degrees, double azimuth) {
  return DirectionAt(std::cos(degrees * pi / 180), azimuth);
}

TEST(PhongTest, HighlightFollowsTheMirrorImage) {
  const Phong phong{kBlack, kWhite, 2};
  // Light at 30 degrees, eye at 30 degrees on the other side: v.r = 1.
  EXPECT_NEAR(Reflected(phong, At(30, 0), At(30, pi))[0], 1 / pi, 1e-15);
  // Eye at the zenith: v.r = cos 30 = sqrt(3/4), squared 3/4.
  EXPECT_NEAR(Reflected(phong, At(30, 0), kUp)[0], 0.75 / pi, 1e-15);
  // More than 90 degrees from the mirror image: nothing.
  EXPECT_EQ(Reflected(phong, At(60, 0), At(60, 0))[0], 0);
}

TEST(BlinnPhongTest, HighlightFollowsTheHalfVector) {
  const BlinnPhong blinn{{0.5, 0.5, 0.5}, kWhite, 4};
  // Light at 60 degrees, eye at the zenith: n.h = cos 30, to the fourth 9/16; diffuse 0.5 cos 60.
  EXPECT_NEAR(Reflected(blinn, At(60, 0), kUp)[0], (0.25 + 9.0 / 16) / pi, 1e-15);
}

TEST(SurfaceSplitTest, MetallicMovesColourFromDiffuseToSpecular) {
  const SurfaceSplit plastic = SplitSurface({{0.5, 0.2, 0}, 0, {}, 0.5}, kDielectricSpecular);
  EXPECT_NEAR(plastic.diffuse[0], 0.48, 1e-15);
  EXPECT_EQ(plastic.specular[1], 0.04);
  const SurfaceSplit metal = SplitSurface({{0.5, 0.2, 0}, 1, {}, 0.5}, kDielectricSpecular);
  EXPECT_EQ(metal.diffuse, kBlack);
  EXPECT_EQ(metal.specular, (Rgb{0.5, 0.2, 0}));
  const SurfaceSplit half = SplitSurface({{0.5, 0.2, 0}, 0.5, {}, 0.5}, kDielectricSpecular);
  EXPECT_NEAR(half.diffuse[1], 0.2 * 0.48, 1e-15);
  EXPECT_NEAR(half.specular[0], 0.27, 1e-15);
  EXPECT_NEAR(SplitSurfaceHdrp({{0.5, 0.2, 0}, 0.25, {}, 0.5}).diffuse[0], 0.375, 1e-15);
}

TEST(SurfaceSplitTest, SpecularSetUpTakesTheStrongestChannelFromDiffuse) {
  const SurfaceSplit split =
      SplitSurface({{1, 0.5, 0}, 0.9, Rgb{0.1, 0.2, 0.6}, 0.5}, kDielectricSpecular);
  EXPECT_NEAR(split.diffuse[0], 0.4, 1e-15);
  EXPECT_NEAR(split.diffuse[1], 0.2, 1e-15);
  EXPECT_EQ(split.specular[2], 0.6);
}

TEST(SurfaceSplitTest, RoughnessIsTheSquareOfOneMinusSmoothness) {
  const Surface surface{kWhite, 0, {}, 0.4};
  EXPECT_DOUBLE_EQ(surface.PerceptualRoughness(), 0.6);
  EXPECT_DOUBLE_EQ(surface.Roughness(0.002), 0.36);
}

TEST(StandardTest, BlackSpecularColourIsPureDisneyDiffuse) {
  const Standard matte{Surface{kWhite, 0, kBlack, 0.5}};
  // From the zenith, light from there too: F90 does not matter.
  EXPECT_NEAR(Reflected(matte, kUp, kUp)[0], 1 / pi, 1e-15);
}

TEST(StandardTest, GammaModeTakesTheRootOfTheHighlight) {
  const Surface metal{kWhite, 1, {}, 0};
  // pi D V = 1 * 1/4 at the zenith; its root is 1/2.
  EXPECT_NEAR(Reflected(Standard{metal}, kUp, kUp)[0], 0.25 / pi, 1e-15);
  EXPECT_NEAR(Reflected(Standard{metal, SmithForm::kExact, true}, kUp, kUp)[0], 0.5 / pi, 1e-15);
}

TEST(StandardTest, SurroundIsReflectedAsTheShaderHasIt) {
  const Standard standard{Surface{{0.5, 0.5, 0.5}, 0, {}, 0.5}};
  // roughness 0.25: 1 / (1 + 1/16) = 16/17; seen from above f0, at the horizon min(0.5 + 0.04, 1).
  EXPECT_NEAR(standard.AmbientReflected(1)[0], 0.48 + 0.04 * 16 / 17, 1e-15);
  EXPECT_NEAR(standard.AmbientReflected(0)[0], 0.48 + 0.54 * 16 / 17, 1e-15);
}

TEST(UrpLitTest, ValueByHand) {
  const UrpLit metal{Surface{kWhite, 1, {}, 0.5}};
  // r = 0.25: 1/16 / ((1/16 + 1e-5)^2 * 1 * 3)
  const double spread = 0.0625 + 1e-5;
  EXPECT_NEAR(Reflected(metal, kUp, kUp)[0], 0.0625 / (spread * spread * 3) / pi, 1e-14);
}

TEST(HdrpLitTest, DiffuseIsDisneyOverItsScale) {
  const HdrpLit plastic{Surface{kWhite, 0, kBlack, 0.5}, false};
  EXPECT_NEAR(Reflected(plastic, kUp, kUp)[0], 1 / 1.03571 / pi, 1e-15);
}

TEST(PropertyTableTest, TranslatesBetweenPipelines) {
  EXPECT_EQ(PropertyTable().size(), 14u);
  using enum UnityShader;
  EXPECT_EQ(TranslateProperty("_Glossiness", kStandard, kHdrpLit), "_Smoothness");
  EXPECT_EQ(TranslateProperty("_BaseColor", kHdrpLit, kStandard), "_Color");
  EXPECT_EQ(TranslateProperty("_MetallicGlossMap", kUrpLit, kHdrpLit), "_MaskMap");
  EXPECT_EQ(TranslateProperty("_Parallax", kStandard, kHdrpLit), std::nullopt);
  EXPECT_EQ(TranslateProperty("_Nonsense", kStandard, kUrpLit), std::nullopt);
  EXPECT_EQ(TranslateProperty("", kHdrpLit, kStandard), std::nullopt);
}

}  // namespace
}  // namespace eyebox::optics
