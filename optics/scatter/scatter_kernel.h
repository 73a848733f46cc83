// The weight w with which light from another direction enters a reading: p = integral of w I
// (Murray, Patel & Wiedenmann 2022, eq 4), radial, as a core with a wide tail and a pedestal.
#ifndef EYEBOX_OPTICS_SCATTER_SCATTER_KERNEL_H_
#define EYEBOX_OPTICS_SCATTER_SCATTER_KERNEL_H_

#include "absl/status/status.h"

namespace eyebox::optics {

enum class CoreShape {
  kGaussian,  // exp(-r^2 / (2 core_radius^2))
  kDisk,      // constant within core_radius: a pupil, or a spot photometer's target
};
enum class TailShape {
  kMoffat,    // (1 + (r / tail_radius)^2)^(-tail_exponent / 2)
  kPowerLaw,  // (r / tail_radius)^-tail_exponent, 1 within tail_radius
};

// w(r) = (1 - tail_share - pedestal_share) core(r) + tail_share tail(r) + pedestal_share / (pi
// reach^2), each part normalised to integral 1 within `reach_deg`; w is 0 beyond. Both tails fall
// as r^-tail_exponent far out. Small angles: the sphere counts as a plane.
struct ScatterKernel {
  CoreShape core = CoreShape::kGaussian;
  TailShape tail = TailShape::kMoffat;
  double core_radius_deg = 0.02;
  double tail_share = 0;  // of the energy
  double tail_radius_deg = 1;
  double tail_exponent = 3;
  double pedestal_share = 0;  // of the energy
  double reach_deg = 60;

  double CoreShare() const { return 1 - tail_share - pedestal_share; }
  // Errors: InvalidArgument naming the field (radius not above 0, core wider than the reach, share
  // outside 0 to 1, no energy left for the core, exponent outside 0.1 to 40, anything not finite).
  absl::Status Validate() const;
};

// The core alone, sum 1.
ScatterKernel CoreOf(const ScatterKernel& kernel);

// Energy of one part of w, were it alone, within a radius, and how it answers to the part's shape.
struct PartEnergy {
  double energy = 0;       // 0 to 1
  double by_radius = 0;    // derivative by the logarithm of the part's own radius
  double by_exponent = 0;  // by the logarithm of tail_exponent; 0 for a core
};

// A valid kernel, ready for many evaluations. Relative errors below 1e-13.
class RadialWeight {
 public:
  explicit RadialWeight(const ScatterKernel& kernel);

  // w(r), 1/deg2.
  double Density(double radius_deg) const;
  // Integral of w over a disk of this radius around the axis: 0 at 0, 1 at the reach and beyond.
  double EnergyWithin(double radius_deg) const;
  PartEnergy CoreWithin(double radius_deg) const;
  PartEnergy TailWithin(double radius_deg) const;
  // From here on the core has all its energy, to the last digit of a double.
  double CoreEndDeg() const;
  const ScatterKernel& kernel() const { return kernel_; }

 private:
  double CoreEnergy(double radius_deg) const;
  double TailMass(double radius_deg) const;  // times 1 / (pi tail_radius^2), before normalisation
  PartEnergy CoreSlopes(double radius_deg) const;  // before normalisation, as the next
  PartEnergy TailSlopes(double radius_deg) const;

  ScatterKernel kernel_;
  PartEnergy core_whole_;  // of the core within the reach, were it not cut there
  PartEnergy tail_whole_;  // tail mass at the reach
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_SCATTER_KERNEL_H_
