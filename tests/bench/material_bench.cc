// Shading of patches, a model each and a scene each. Items are patches; counter `times_unlit`: time
// a patch over that of an unlit one in this run. "Needs" tells what the scene asks for.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>

#include "optics/render/scene/scene.h"

namespace eyebox::optics {
namespace {

constexpr Rgb kGrey = {0.5, 0.5, 0.5};
constexpr int kPatches = 1024;

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<Patch> Patches() {
  std::vector<Patch> patches;
  for (int i = 0; i < kPatches; ++i) {
    const double slant = 0.6 * std::sin(0.1 * i);
    const double tilt = 0.02 * i;
    patches.push_back(
        {0,
         {0.001 * i, 0, 1},
         {std::sin(slant) * std::cos(tilt), std::sin(slant) * std::sin(tilt), -std::cos(slant)},
         {0, 0, -1}});
  }
  return patches;
}

// `count` lights of all kinds but ambient, then one ambient if asked for.
std::vector<Light> Lights(int count, bool ambient) {
  std::vector<Light> lights;
  for (int i = 0; i < count; ++i) {
    const Rgb colour = {1, 0.9, 0.8};
    const PointLight point{colour, 50, {0.5 * i - 1, 1, -2}, 20};
    if (i % 3 == 0) lights.emplace_back(DirectionalLight{colour, 1, TowardsLight(20, 10 * i)});
    if (i % 3 == 1) lights.emplace_back(point);
    if (i % 3 == 2) lights.emplace_back(SpotLight{point, {0, -0.316228, 0.948683}, 90, 0.5});
  }
  if (ambient) lights.emplace_back(AmbientLight{{1, 1, 1}, 0.2});
  return lights;
}

Scene SceneOf(const Material& material, std::vector<Light> lights) {
  return {{}, {material}, std::move(lights)};
}

double SecondsAPatch(const PreparedScene& scene, const std::vector<Patch>& patches, int rounds) {
  const double start_s = CpuSeconds();
  for (int round = 0; round < rounds; ++round) {
    for (const Patch& patch : patches) benchmark::DoNotOptimize(Shade(scene, patch));
  }
  return (CpuSeconds() - start_s) / rounds / kPatches;
}

double UnlitSeconds() {
  static const double seconds =
      SecondsAPatch(Prepare(SceneOf(Unlit{kGrey}, Lights(6, true))), Patches(), 2000);
  return seconds;
}

void Shading(benchmark::State& state, const Scene& scene) {
  const std::vector<Patch> patches = Patches();
  const PreparedScene prepared = Prepare(scene);
  const double unlit_s = UnlitSeconds();
  const double start_s = CpuSeconds();
  for (auto _ : state) {
    for (const Patch& patch : patches) benchmark::DoNotOptimize(Shade(prepared, patch));
  }
  const auto done = static_cast<double>(state.iterations()) * kPatches;
  state.counters["times_unlit"] = (CpuSeconds() - start_s) / done / unlit_s;
  state.SetItemsProcessed(state.iterations() * kPatches);
}

Surface SurfaceOf(double metallic) { return {kGrey, metallic, {}, 0.6}; }

#define EYEBOX_SHADING(name, material, lights) \
  BENCHMARK_CAPTURE(Shading, name, SceneOf(material, lights))->Unit(benchmark::kMicrosecond)

EYEBOX_SHADING(unlit_six_lights, Unlit{kGrey}, Lights(6, true));
EYEBOX_SHADING(lambert_one_light, LitMaterial(Lambert{kGrey}), Lights(1, false));
EYEBOX_SHADING(phong_one_light, LitMaterial(Phong{kGrey, kGrey, 20}), Lights(1, false));
EYEBOX_SHADING(blinn_phong_one_light, LitMaterial(BlinnPhong{kGrey, kGrey, 20}), Lights(1, false));
EYEBOX_SHADING(cook_torrance_one_light, LitMaterial(CookTorrance{kGrey}), Lights(1, false));
EYEBOX_SHADING(standard_one_light, LitMaterial(Standard{SurfaceOf(0)}), Lights(1, false));
EYEBOX_SHADING(urp_lit_one_light, LitMaterial(UrpLit{SurfaceOf(0)}), Lights(1, false));
EYEBOX_SHADING(hdrp_lit_one_light, (LitMaterial(HdrpLit{SurfaceOf(0), false})), Lights(1, false));
EYEBOX_SHADING(hdrp_lit_compensated_one_light, LitMaterial(HdrpLit{SurfaceOf(0)}),
               Lights(1, false));
EYEBOX_SHADING(standard_six_lights, LitMaterial(Standard{SurfaceOf(0)}), Lights(6, false));
EYEBOX_SHADING(standard_six_lights_ambient, LitMaterial(Standard{SurfaceOf(0)}), Lights(6, true));
EYEBOX_SHADING(standard_metal_six_lights, LitMaterial(Standard{SurfaceOf(1)}), Lights(6, false));
EYEBOX_SHADING(lambert_six_lights_ambient, LitMaterial(Lambert{kGrey}), Lights(6, true));

}  // namespace
}  // namespace eyebox::optics
