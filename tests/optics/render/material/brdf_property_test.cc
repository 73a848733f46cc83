// What every reflection model promises, looked for by random search.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>

#include "tests/optics/render/material/hemisphere.h"

namespace eyebox::optics {
namespace {

// Every run the same.
const int kSeeded = setenv("RC_PARAMS", "seed=20 max_success=2000", 1);

// In [0, 1]; the ends and what lies next to them come often.
rc::Gen<double> Unit() {
  return rc::gen::oneOf(
      rc::gen::map(rc::gen::inRange(0, 1 << 24),
                   [](int k) { return static_cast<double>(k) / ((1 << 24) - 1); }),
      rc::gen::element(0.0, 1e-300, 1e-12, 1e-4, 1 - 1e-12, 1.0));
}

Rgb AnyColour() { return {*Unit(), *Unit(), *Unit()}; }

Vec3 AnyDirection() { return DirectionAt(*Unit(), 6.2831853 * *Unit()); }

Surface AnySurface() {
  Surface surface{AnyColour(), *Unit(), {}, *Unit()};
  if (*rc::gen::arbitrary<bool>()) surface.specular = AnyColour();
  return surface;
}

LitMaterial AnyMaterial() {
  switch (*rc::gen::inRange(0, 8)) {
    case 0:
      return Lambert{AnyColour()};
    case 1:
      return Phong{AnyColour(), AnyColour(), 1 + 1000 * *Unit()};
    case 2:
      return BlinnPhong{AnyColour(), AnyColour(), 1 + 1000 * *Unit()};
    case 3:
      return CookTorrance{AnyColour(), DielectricFresnel{0.3 + 3 * *Unit()}, *Unit(),
                          HighlightScale::kPublished};
    case 4:
      return CookTorrance{AnyColour(), SchlickFresnel{AnyColour()}, *Unit(),
                          HighlightScale::kNormalised};
    case 5:
      return Standard{AnySurface(),
                      *rc::gen::arbitrary<bool>() ? SmithForm::kExact : SmithForm::kShader,
                      *rc::gen::arbitrary<bool>()};
    case 6:
      return UrpLit{AnySurface()};
    default:
      return HdrpLit{AnySurface(), false};
  }
}

RC_GTEST_PROP(BrdfProperty, IsNeverNegativeAndAlwaysFinite, ()) {
  const LitMaterial material = AnyMaterial();
  const Rgb reflected = Reflected(material, AnyDirection(), AnyDirection());
  for (const double value : reflected) RC_ASSERT(std::isfinite(value) && value >= 0);
}

RC_GTEST_PROP(BrdfProperty, IsReciprocalWhereItClaimsToBe, ()) {
  const LitMaterial material = AnyMaterial();
  if (!ClaimsOf(material).reciprocal) return;
  const Vec3 light = AnyDirection();
  const Vec3 view = AnyDirection();
  // Below this a cosine has lost its digits to the rounding of the vectors.
  RC_PRE(light.y > 1e-9 && view.y > 1e-9);
  RC_ASSERT(ReciprocityError(material, light, view) < 1e-12);
}

RC_GTEST_PROP(BrdfProperty, NothingComesFromBehind, ()) {
  const LitMaterial material = AnyMaterial();
  const Vec3 light = AnyDirection();
  const Vec3 below = {light.x, -light.y, light.z};
  RC_ASSERT(IsBlack(Reflected(material, below, AnyDirection())));
}

RC_GTEST_PROP(BrdfProperty, SurroundGivesFiniteLight, ()) {
  const LitMaterial material = AnyMaterial();
  const double n_v = *Unit();
  const Rgb ambient = std::visit([&](const auto& m) { return m.AmbientReflected(n_v); }, material);
  for (const double value : ambient) RC_ASSERT(std::isfinite(value) && value >= 0);
}

TEST(BrdfEnergy, IsConservedWhereItIsClaimed) {
  constexpr Rgb kWhite = {1, 1, 1};
  constexpr Rgb kBlack = {};
  for (const double smoothness : {0.0, 0.4, 0.75}) {
    const Surface metal{kWhite, 1, {}, smoothness};
    const double width = metal.Roughness(0.05);
    const LitMaterial materials[] = {
        Standard{metal}, HdrpLit{metal, false},
        CookTorrance{kBlack, SchlickFresnel{kWhite}, width, HighlightScale::kNormalised}};
    for (const LitMaterial& material : materials) {
      ASSERT_TRUE(ClaimsOf(material).conserves_energy);
      for (const double n_l : {0.02, 0.3, 1.0}) {
        const double albedo = DirectionalAlbedo(material, n_l, {1200, 96, width});
        EXPECT_LE(albedo, 1 + 1e-6) << NameOf(material) << " " << smoothness << " " << n_l;
      }
    }
  }
}

TEST(BrdfEnergy, IsConservedByLambert) {
  const LitMaterial white = Lambert{{1, 1, 1}};
  ASSERT_TRUE(ClaimsOf(white).conserves_energy);
  EXPECT_FALSE(ClaimsOf(Lambert{{1, 1.01, 1}}).conserves_energy);
  for (const double n_l : {0.02, 0.3, 1.0}) {
    EXPECT_NEAR(DirectionalAlbedo(white, n_l, {3000, 512, 1}), 1, 1e-6) << n_l;
  }
}

TEST(BrdfEnergy, IsNotClaimedWhereItIsExceeded) {
  constexpr Rgb kWhite = {1, 1, 1};
  constexpr Rgb kBlack = {};
  const Surface plastic{kWhite, 0, {}, 0.0};
  const LitMaterial materials[] = {
      Phong{kBlack, kWhite, 10},
      BlinnPhong{kBlack, kWhite, 10},
      CookTorrance{kBlack, SchlickFresnel{kWhite}, 0.3},
      CookTorrance{kWhite, SchlickFresnel{}, 0.3, HighlightScale::kNormalised},
      Standard{plastic},
      HdrpLit{plastic, false},
      UrpLit{Surface{kWhite, 1, {}, 0.5}}};
  for (const LitMaterial& material : materials) {
    EXPECT_FALSE(ClaimsOf(material).conserves_energy) << NameOf(material);
    double largest = 0;
    for (const double n_l : {0.02, 1.0}) {
      largest = std::max(largest, DirectionalAlbedo(material, n_l, {400, 64, 0.3}));
    }
    EXPECT_GT(largest, 1.01) << NameOf(material);
    ::testing::Test::RecordProperty(std::string("albedo_") + std::string(NameOf(material)),
                                    std::to_string(largest));
  }
}

// Light from everywhere, radiance 1: what leaves towards an eye is the directional albedo for light
// from the eye, where light may be turned round.
TEST(Furnace, IntegralsOfTheLibraryAgreeWithQuadratureFromOutside) {
  for (const double smoothness : {0.0, 0.3, 0.7}) {
    const Surface surface{{0.7, 0.5, 0.2}, 0.3, {}, smoothness};
    const double width = surface.Roughness(0.05);
    const HdrpLit hdrp{surface, false};
    const CookTorrance cook{{0.2, 0.2, 0.2}, DielectricFresnel{1.5}, width};
    for (const double n_v : {0.05, 0.3, 0.7, 1.0}) {
      const AlbedoGrid grid = {1000, 128, width};
      const double seen = DirectionalAlbedo(LitMaterial(hdrp), n_v, grid);
      EXPECT_NEAR(hdrp.AmbientReflected(n_v)[0] / seen, 1, 1e-3) << smoothness << " " << n_v;
      const double cooked = DirectionalAlbedo(LitMaterial(cook), n_v, grid);
      EXPECT_NEAR(cook.AmbientReflected(n_v)[0] / cooked, 1, 1e-3) << width << " " << n_v;
    }
  }
}

TEST(Furnace, WhiteMetalVanishesInItWithCompensation) {
  for (const double smoothness : {0.0, 0.5, 0.9, 1.0}) {
    const HdrpLit metal{Surface{{1, 1, 1}, 1, {}, smoothness}};
    for (const double n_v : {0.01, 0.2, 0.6, 1.0}) {
      EXPECT_NEAR(metal.AmbientReflected(n_v)[0], 1, 1e-12);
      const double without = HdrpLit{metal.surface, false}.AmbientReflected(n_v)[0];
      EXPECT_LE(without, 1 + 1e-6) << smoothness << " " << n_v;
    }
  }
}

TEST(Furnace, LambertReturnsItsColour) {
  const Lambert grey{{0.18, 0.18, 0.18}};
  EXPECT_EQ(grey.AmbientReflected(0.3)[0], 0.18);
  EXPECT_NEAR(DirectionalAlbedo(LitMaterial(grey), 0.3, {1000, 64, 1}), 0.18, 1e-6);
}

}  // namespace
}  // namespace eyebox::optics
