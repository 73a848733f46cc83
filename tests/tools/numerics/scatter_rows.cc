// The scatter kernel: its density and its energy within a radius.
#include <cmath>

#include "optics/scatter/scatter_kernel.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

using optics::CoreShape;
using optics::ScatterKernel;
using optics::TailShape;

Digits50 CoreEnergy50(const ScatterKernel& kernel, const Digits50& radius) {
  const Digits50 ratio2 =
      radius * radius / (Digits50(kernel.core_radius_deg) * kernel.core_radius_deg);
  if (kernel.core == CoreShape::kDisk) return ratio2 < 1 ? ratio2 : Digits50(1);
  return 1 - exp(Digits50(-ratio2 / 2));
}

Digits50 PowerIntegral50(const Digits50& k, const Digits50& q) {
  return k == 0 ? Digits50(log(q)) : Digits50((pow(q, k) - 1) / k);
}

Digits50 TailMass50(const ScatterKernel& kernel, const Digits50& radius) {
  const Digits50 ratio = radius / kernel.tail_radius_deg;
  const Digits50 q = ratio * ratio;
  const Digits50 k = 1 - Digits50(kernel.tail_exponent) / 2;
  if (kernel.tail == TailShape::kMoffat) return PowerIntegral50(k, 1 + q);
  return q <= 1 ? q : Digits50(1 + PowerIntegral50(k, q));
}

Digits50 CoreShare50(const ScatterKernel& kernel) {
  return 1 - Digits50(kernel.tail_share) - kernel.pedestal_share;
}

Digits50 Energy50(const ScatterKernel& kernel, const Digits50& radius) {
  const Digits50 reach = kernel.reach_deg;
  return CoreShare50(kernel) * CoreEnergy50(kernel, radius) / CoreEnergy50(kernel, reach) +
         kernel.tail_share * TailMass50(kernel, radius) / TailMass50(kernel, reach) +
         kernel.pedestal_share * radius * radius / (reach * reach);
}

Digits50 Density50(const ScatterKernel& kernel, const Digits50& radius) {
  const Digits50 reach = kernel.reach_deg;
  const Digits50 core2 = Digits50(kernel.core_radius_deg) * kernel.core_radius_deg;
  const Digits50 tail2 = Digits50(kernel.tail_radius_deg) * kernel.tail_radius_deg;
  Digits50 core = radius * radius <= core2 ? 1 : 0;
  if (kernel.core == CoreShape::kGaussian) core = exp(Digits50(-radius * radius / (2 * core2))) / 2;
  const Digits50 q = radius * radius / tail2;
  const Digits50 base = kernel.tail == TailShape::kMoffat ? 1 + q : (q > 1 ? q : Digits50(1));
  const Digits50 tail = pow(base, Digits50(-Digits50(kernel.tail_exponent) / 2));
  return (CoreShare50(kernel) * core / (core2 * CoreEnergy50(kernel, reach)) +
          kernel.tail_share * tail / (tail2 * TailMass50(kernel, reach)) +
          kernel.pedestal_share / (reach * reach)) /
         (4 * atan(Digits50(1)));
}

}  // namespace

void AddScatterRows(Density density, std::vector<Row>& rows) {
  WorstCase energy("RadialWeight::EnergyWithin", 1e-13);
  WorstCase weight("RadialWeight::Density", 1e-13);
  for (const CoreShape core : {CoreShape::kGaussian, CoreShape::kDisk}) {
    for (const TailShape tail : {TailShape::kMoffat, TailShape::kPowerLaw}) {
      for (const double exponent :
           {0.1, 1.0, 2 - 1e-6, 2 - 1e-10, 2.0, 2 + 1e-10, 3.0, 12.0, 40.0}) {
        for (const double tail_radius : {1e-3, 0.1, 1.0, 30.0}) {
          for (const double share : {0.0, 1e-3, 0.3}) {
            const ScatterKernel kernel = {core,        tail,     0.0165, share,
                                          tail_radius, exponent, 0.002,  60};
            const optics::RadialWeight radial(kernel);
            for (const double radius : LogSteps(1e-9, 59.999, 12 * density.steps)) {
              const Arguments where = {{"exponent - 2", exponent - 2},
                                       {"tail radius", tail_radius},
                                       {"tail share", share},
                                       {"radius deg", radius}};
              energy.Compare(radial.EnergyWithin(radius), Energy50(kernel, radius), where);
              weight.Compare(radial.Density(radius), Density50(kernel, radius), where);
            }
          }
        }
      }
    }
  }
  rows.push_back(energy.row());
  rows.push_back(weight.row());
}

}  // namespace eyebox::numerics
