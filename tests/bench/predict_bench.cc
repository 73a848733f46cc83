// Rows predicted a second: a million rows of each kind. The yardstick is the published model.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "fit/renderer/hdrp_model.h"
#include "fit/renderer/known_knots.h"

namespace eyebox::fit {
namespace {

constexpr int kRows = 1'000'000;

const std::vector<SceneRow>& Rows() {
  static const std::vector<SceneRow> rows = [] {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<SceneRow> made(kRows);
    for (SceneRow& row : made) {
      row.material = {uniform(random), uniform(random), uniform(random)};
      row.facing = uniform(random);
      row.directional_intensity = 6 * uniform(random);
      row.directional_color = {uniform(random), uniform(random), uniform(random)};
      row.ambient_intensity = 2 * uniform(random);
      row.ambient_color = {uniform(random), uniform(random), uniform(random)};
    }
    return made;
  }();
  return rows;
}

void Predict(benchmark::State& state, const HdrpModel& model, RowMaterial material,
             const optics::ColourTable* cube) {
  const auto renderer = HdrpRenderer::Create(model, cube);
  if (!renderer.ok()) std::abort();
  for (auto _ : state) {
    double sum = 0;
    for (const SceneRow& row : Rows()) sum += renderer->Predict(row, material).stored[1];
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * kRows);
}

const optics::ColourTable& SquareRootCube() {
  static const optics::ColourTable cube = [] {
    std::vector<double> entries = {0, 0};
    for (const double u : KnotsFromOptimisation()) entries.push_back(std::min(std::sqrt(u), 1.0));
    return optics::SeparableTable(entries);
  }();
  return cube;
}

void BM_PublishedUnlit(benchmark::State& state) {
  Predict(state, HdrpModel::Published(), RowMaterial::kUnlit, nullptr);
}
void BM_PublishedLambertian(benchmark::State& state) {
  Predict(state, HdrpModel::Published(), RowMaterial::kLambertian, nullptr);
}
void BM_Unlit(benchmark::State& state) {
  Predict(state, HdrpModel(), RowMaterial::kUnlit, nullptr);
}
void BM_Lambertian(benchmark::State& state) {
  Predict(state, HdrpModel(), RowMaterial::kLambertian, nullptr);
}
void BM_LambertianThroughCube(benchmark::State& state) {
  Predict(state, HdrpModel(), RowMaterial::kLambertian, &SquareRootCube());
}

BENCHMARK(BM_PublishedUnlit)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PublishedLambertian)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Unlit)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Lambertian)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_LambertianThroughCube)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace eyebox::fit
