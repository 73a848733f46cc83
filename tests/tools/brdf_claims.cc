// What every reflection model claims and what is measured: largest and smallest value, largest
// directional albedo and where, largest reciprocity error. Prints a table; exit 1 where a claim
// does not hold.
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "tests/optics/render/material/hemisphere.h"

namespace eyebox::optics {
namespace {

constexpr Rgb kWhite = {1, 1, 1};
constexpr Rgb kBlack = {0, 0, 0};
constexpr double kCosines[] = {1e-3, 0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1};
constexpr double kEnergyTolerance = 1e-6;
constexpr double kReciprocityTolerance = 1e-9;

struct Case {
  std::string settings;
  LitMaterial material;
  double sharpness = 0.3;
};

Surface SurfaceOf(double metallic, double smoothness) {
  return {.base = kWhite, .metallic = metallic, .specular = {}, .smoothness = smoothness};
}

std::vector<Case> Classics() {
  std::vector<Case> cases = {{"white", Lambert{kWhite}}};
  for (const double exponent : {1.0, 10.0, 100.0}) {
    const std::string settings = "specular 1, h " + std::to_string(static_cast<int>(exponent));
    cases.push_back({settings, Phong{kBlack, kWhite, exponent}});
    cases.push_back({settings, BlinnPhong{kBlack, kWhite, exponent}});
  }
  cases.push_back({"diffuse 1, specular 1, h 10", Phong{kWhite, kWhite, 10}});
  cases.push_back({"diffuse 1, specular 1, h 10", BlinnPhong{kWhite, kWhite, 10}});
  for (const double m : {0.05, 0.3, 1.0}) {
    for (const auto scale : {HighlightScale::kPublished, HighlightScale::kNormalised}) {
      const std::string form = scale == HighlightScale::kPublished ? "published" : "normalised";
      cases.push_back({form + ", f0 1, m " + std::to_string(m).substr(0, 4),
                       CookTorrance{kBlack, SchlickFresnel{kWhite}, m, scale}, m});
    }
  }
  cases.push_back({"normalised, diffuse 1, index 1.5, m 0.3",
                   CookTorrance{kWhite, DielectricFresnel{1.5}, 0.3, HighlightScale::kNormalised}});
  return cases;
}

std::vector<Case> Physical() {
  std::vector<Case> cases;
  for (const double metallic : {1.0, 0.0}) {
    for (const double smoothness : {0.0, 0.5, 0.8, 1.0}) {
      const Surface surface = SurfaceOf(metallic, smoothness);
      const std::string settings = (metallic == 1 ? "white metal, " : "white dielectric, ") +
                                   std::string("smoothness ") +
                                   std::to_string(smoothness).substr(0, 3);
      const double sharpness = surface.Roughness(HdrpLit::kRoughnessFloor);
      cases.push_back({settings, Standard{surface}, sharpness});
      cases.push_back(
          {settings + ", shader's Smith", Standard{surface, SmithForm::kShader}, sharpness});
      cases.push_back({settings, UrpLit{surface}, sharpness});
      cases.push_back({settings, HdrpLit{surface, false}, sharpness});
      cases.push_back({settings + ", compensated", HdrpLit{surface, true}, sharpness});
    }
  }
  Standard gamma{SurfaceOf(0, 0.5)};
  gamma.gamma_mode = true;
  cases.push_back({"white dielectric, smoothness 0.5, Gamma mode", gamma, 0.25});
  return cases;
}

struct Finding {
  double albedo = 0;
  double at_cosine = 0;
  double reciprocity = 0;
  double least = 0;
};

// The compensation of HDRP Lit is an integral for every eye: taken from a table here.
double AlbedoOfCompensated(const HdrpLit& material, double n_l, const AlbedoGrid& grid) {
  constexpr int kEntries = 1000;
  std::vector<double> table;
  for (int i = 0; i <= kEntries; ++i) {
    const double n_v = static_cast<double>(i * i) / (kEntries * kEntries);
    table.push_back(material.Compensation(n_v)[0]);
  }
  return DirectionalAlbedo(
      [&](const Directions& d) {
        const double place = kEntries * std::sqrt(std::min(d.n_v, 1.0));
        const int below = std::min(static_cast<int>(place), kEntries - 1);
        const double factor = std::lerp(table[below], table[below + 1], place - below);
        return material.Reflected(d, {factor, factor, factor});
      },
      n_l, grid);
}

Finding Measure(const Case& one) {
  Finding found;
  const auto* hdrp = std::get_if<HdrpLit>(&one.material);
  const bool compensated = hdrp != nullptr && hdrp->energy_compensation;
  for (const double cosine : kCosines) {
    const AlbedoGrid grid = {.sharpness = one.sharpness};
    const double albedo = compensated ? AlbedoOfCompensated(*hdrp, cosine, grid)
                                      : DirectionalAlbedo(one.material, cosine, grid);
    if (albedo > found.albedo) {
      found.albedo = albedo;
      found.at_cosine = cosine;
    }
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < (compensated ? 500 : 20000); ++i) {
    const Vec3 light = DirectionAt(uniform(random), 6.3 * uniform(random));
    const Vec3 view = DirectionAt(uniform(random), 6.3 * uniform(random));
    found.least = std::min(found.least, Reflected(one.material, light, view)[0]);
    found.reciprocity = std::max(found.reciprocity, ReciprocityError(one.material, light, view));
  }
  return found;
}

bool Print(const Case& one) {
  const Claims claims = ClaimsOf(one.material);
  const Finding found = Measure(one);
  const bool holds = found.least >= 0 &&
                     (!claims.conserves_energy || found.albedo <= 1 + kEnergyTolerance) &&
                     (!claims.reciprocal || found.reciprocity <= kReciprocityTolerance);
  std::printf("%-14s %-46s %-5s %10.6f at %-6g %-5s %9.2e%s\n",
              std::string(NameOf(one.material)).c_str(), one.settings.c_str(),
              claims.conserves_energy ? "yes" : "no", found.albedo, found.at_cosine,
              claims.reciprocal ? "yes" : "no", found.reciprocity, holds ? "" : "  DOES NOT HOLD");
  return holds;
}

}  // namespace
}  // namespace eyebox::optics

int main() {
  std::printf("%-14s %-46s %-5s %20s %-5s %9s\n", "model", "settings", "cons.",
              "largest albedo, n.l", "rec.", "error");
  bool sound = true;
  for (const auto& cases : {eyebox::optics::Classics(), eyebox::optics::Physical()}) {
    for (const auto& one : cases) sound = eyebox::optics::Print(one) && sound;
  }
  return sound ? 0 : 1;
}
