// Glare series of a known kernel.
#ifndef EYEBOX_TESTS_FIT_SCATTER_SIMULATED_GLARE_H_
#define EYEBOX_TESTS_FIT_SCATTER_SIMULATED_GLARE_H_

#include <array>
#include <cmath>
#include <cstdint>

#include "capture/base/random.h"
#include "fit/scatter/fit_scatter.h"
#include "optics/scatter/disk_energy.h"

namespace eyebox::fit {

inline double Gaussian(RandomStream& random) {
  const double radius = std::sqrt(-2 * std::log(random.Uniform()));
  return radius * std::cos(6.283185307179586 * random.Uniform());
}

struct GlareScene {
  double bright = 59;
  double background = 0.19;
  double relative_sigma = 0.003;
  double absolute_sigma = 1e-4;
  bool small_source = true;
  bool black_disks = true;
};

// Energy in a disk of this radius and offset.
template <typename Energy>
GlareSeries SimulateGlare(const Energy& energy, const GlareScene& scene, uint64_t seed) {
  RandomStream random({seed});
  GlareSeries series{{}, 50, "cd/m2", "simulated"};
  const auto add = [&](GlarePattern pattern, double diameter, double offset) {
    const double disk = energy(optics::Disk{diameter / 2, offset});
    const double rest = energy(optics::Disk{series.field_radius_deg, offset}) - disk;
    const bool bright_disk = pattern == GlarePattern::kBrightDisk;
    const double light =
        scene.bright * (bright_disk ? disk : rest) + scene.background * (bright_disk ? rest : disk);
    const double sigma = std::hypot(scene.relative_sigma * light, scene.absolute_sigma);
    series.readings.push_back({pattern, diameter, offset, light + sigma * Gaussian(random), sigma});
  };
  add(GlarePattern::kBrightDisk, 0, 0);
  for (const double diameter : {0.06, 0.1, 0.15, 0.2, 0.33, 0.5, 0.8, 1.2, 2.0, 3.5, 6.0, 10.0,
                                15.0, 25.0, 40.0, 60.0, 100.0}) {
    add(GlarePattern::kBrightDisk, diameter, 0);
  }
  for (const double offset : {0.3, 0.5, 0.8, 1.3, 2.0, 3.5, 6.0, 10.0, 16.0}) {
    if (scene.small_source) add(GlarePattern::kBrightDisk, 0.4, offset);
  }
  for (const double diameter : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0}) {
    if (scene.black_disks) add(GlarePattern::kBlackDisk, diameter, 0);
  }
  return series;
}

inline GlareSeries SimulateGlare(const optics::ScatterKernel& kernel, const GlareScene& scene,
                                 uint64_t seed) {
  const optics::RadialWeight weight(kernel);
  return SimulateGlare([&](const optics::Disk& disk) { return optics::EnergyInDisk(weight, disk); },
                       scene, seed);
}

// In the order of the parameters of a fit.
inline std::array<double, kGlareParameters> TruthOf(const optics::ScatterKernel& kernel,
                                                    const GlareScene& scene) {
  return {kernel.core_radius_deg, kernel.tail_share, kernel.tail_radius_deg, kernel.tail_exponent,
          kernel.pedestal_share,  scene.bright,      scene.background};
}

}  // namespace eyebox::fit

#endif  // EYEBOX_TESTS_FIT_SCATTER_SIMULATED_GLARE_H_
