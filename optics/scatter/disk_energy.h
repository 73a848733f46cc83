// How much of a reading's weight falls on a disk of the display.
#ifndef EYEBOX_OPTICS_SCATTER_DISK_ENERGY_H_
#define EYEBOX_OPTICS_SCATTER_DISK_ENERGY_H_

#include <vector>

#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

struct Disk {
  double radius_deg = 0;
  double offset_deg = 0;  // of its centre from the axis of the reading
};

// Integral of w over the disk, 0 to 1. Closed form on the axis; off it to 1e-6 of the energy, and
// where w is smooth over the disk (a small source seen in the tail) to 1e-6 of the result.
double EnergyInDisk(const RadialWeight& weight, const Disk& disk);

// The energy in a disk as a sum of factor E(radius), whatever w is: for many evaluations.
struct EnergySum {
  std::vector<double> radius_deg;  // ascending, infinite for what does not hang on w
  std::vector<double> factor;
};

// To the accuracy of EnergyInDisk, for cores above 1/200 of the disk's radius where its edge passes
// within a few cores of the axis.
EnergySum EnergySumOf(const Disk& disk);

// The same for light that passes two scatterers one after the other, of which the first (the
// instrument) is known: their kernels convolve. What depends on the first alone is tabulated here.
class SecondScatterer {
 public:
  SecondScatterer(const RadialWeight& first, const Disk& disk);

  // Integral of (first * second) over the disk. To 1e-3 of the
  // energy, for a small disk off the axis to 1e-2 of the result.
  double EnergyInDisk(const RadialWeight& second) const;
  EnergySum Sum() const;

 private:
  std::vector<double> radius_deg_;  // ascending from 0
  std::vector<double> energy_;  // in the disk, for an axis moved by that radius in any direction
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_DISK_ENERGY_H_
