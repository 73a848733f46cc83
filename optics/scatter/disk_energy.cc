#include "optics/scatter/disk_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace eyebox::optics {
namespace {

constexpr double kSmallestRadiusDeg = 1e-4;
constexpr double kNodesPerE = 24;   // of the logarithmic grid of radii
constexpr double kTablePerE = 100;  // likewise, where values are interpolated
constexpr int kAngles = 48;
constexpr int kAcrossDisk = 96;  // radii across a disk off the axis

constexpr double kMostEdgeSteps = 4096;

// Steps around the disk's edge that resolve how far it is from the axis.
int EdgeStepsFor(const Disk& disk) {
  const double gap = std::abs(disk.radius_deg - std::abs(disk.offset_deg));
  return static_cast<int>(
      std::clamp(20 * disk.radius_deg / std::max(gap, 1e-12), 96.0, kMostEdgeSteps));
}

// Steps around the disk's edge, fine enough to resolve the core where the edge runs through it.
int EdgeSteps(const RadialWeight& weight, const Disk& disk) {
  const double gap = std::abs(disk.radius_deg - std::abs(disk.offset_deg));
  const double finest = std::max(weight.kernel().core_radius_deg, gap);
  return static_cast<int>(std::clamp(16 * disk.radius_deg / finest, 96.0, kMostEdgeSteps));
}

double FirstNode(double disk_radius_deg) {
  const double ratio = std::max(disk_radius_deg / kSmallestRadiusDeg, 1.0);
  return disk_radius_deg * std::exp(-(std::ceil(std::log(ratio) * kTablePerE) + 0.5) / kTablePerE);
}

// Linear in log radius, constant below the first node. The disk's edge lies midway between two
// nodes, so that its area comes out right even for a weight much narrower than their distance.
class RadialTable {
 public:
  RadialTable(const RadialWeight& weight, double disk_radius_deg, double largest_deg)
      : first_(FirstNode(disk_radius_deg)) {
    const int nodes = static_cast<int>(std::ceil(std::log(largest_deg / first_) * kTablePerE)) + 2;
    for (int i = 0; i < nodes; ++i) {
      const double offset = first_ * std::exp(i / kTablePerE);
      values_.push_back(EnergyInDisk(weight, {disk_radius_deg, offset}));
    }
  }
  double At(double radius_deg) const {
    const double position = std::log(std::max(radius_deg, first_) / first_) * kTablePerE;
    const size_t i = std::min(static_cast<size_t>(position), values_.size() - 2);
    const double part = std::min(position - static_cast<double>(i), 1.0);
    return values_[i] + part * (values_[i + 1] - values_[i]);
  }

 private:
  double first_;
  std::vector<double> values_;
};

// Mean of the table over the directions from `from` to `to`, at a radius around a point that lies
// `offset_deg` from the disk's centre; times the share of half a turn that they make up.
double MeanOverAngles(const RadialTable& table, double offset_deg, double radius_deg, double from,
                      double to) {
  double sum = 0;
  for (int k = 0; k < kAngles; ++k) {
    const double angle = from + (to - from) * (k + 0.5) / kAngles;
    const double square = offset_deg * offset_deg + radius_deg * radius_deg -
                          2 * offset_deg * radius_deg * std::cos(angle);
    sum += table.At(std::sqrt(std::max(square, 0.0)));
  }
  return sum / kAngles * (to - from) / std::numbers::pi;
}

// Directions near the disk are taken more finely: there a small disk has all its light.
double MeanAround(const RadialTable& table, double offset_deg, double radius_deg, double near_deg) {
  const double square = offset_deg * offset_deg + radius_deg * radius_deg - near_deg * near_deg;
  const double cosine =
      std::clamp(square / std::max(2 * offset_deg * radius_deg, 1e-12), -1.0, 1.0);
  const double near = std::acos(cosine);
  return MeanOverAngles(table, offset_deg, radius_deg, 0, near) +
         MeanOverAngles(table, offset_deg, radius_deg, near, std::numbers::pi);
}

// Logarithmic, and close together where the disk's edge passes the core of the first scatterer.
std::vector<double> Radii(const RadialWeight& first, const Disk& disk) {
  std::vector<double> radii = {0};
  const double reach = first.kernel().reach_deg;
  for (double r = kSmallestRadiusDeg; r < reach; r *= std::exp(1 / kNodesPerE)) radii.push_back(r);
  radii.push_back(reach);
  const double core = first.kernel().core_radius_deg;
  for (const double edge :
       {disk.radius_deg + disk.offset_deg, std::abs(disk.radius_deg - disk.offset_deg)}) {
    for (double step = -4; step <= 4; step += 0.25) {
      const double r = edge + step * core;
      if (r > 0 && r < reach) radii.push_back(r);
    }
  }
  for (int k = 1; k < kAcrossDisk && disk.offset_deg > 0; ++k) {
    const double r =
        disk.offset_deg - disk.radius_deg * std::cos(std::numbers::pi * k / kAcrossDisk);
    if (r > 0 && r < reach) radii.push_back(r);
  }
  std::sort(radii.begin(), radii.end());
  return radii;
}

}  // namespace

// The field E(s) / (2 pi s^2) (x, y) has divergence w, so that the energy in the disk is its flux
// through the edge: a smooth periodic integral, for which equal steps converge exponentially.
double EnergyInDisk(const RadialWeight& weight, const Disk& disk) {
  const double a = disk.radius_deg;
  const double rho = std::abs(disk.offset_deg);
  if (!(a > 0)) return 0;
  if (rho == 0) return weight.EnergyWithin(a);
  if (rho - a >= weight.kernel().reach_deg) return 0;
  const int steps = EdgeSteps(weight, disk);
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double cosine = std::cos(std::numbers::pi * (k + 0.5) / steps);
    const double square = std::max(rho * rho + a * a + 2 * rho * a * cosine, 1e-30);
    sum += weight.EnergyWithin(std::sqrt(square)) * (a + rho * cosine) / square;
  }
  return std::clamp(a * sum / steps, 0.0, 1.0);
}

EnergySum EnergySumOf(const Disk& disk) {
  const double a = disk.radius_deg;
  const double rho = std::abs(disk.offset_deg);
  if (!(a > 0)) return {};
  if (rho == 0) return {{a}, {1}};
  const int steps = EdgeStepsFor(disk);
  EnergySum sum;
  for (int k = steps - 1; k >= 0; --k) {
    const double cosine = std::cos(std::numbers::pi * (k + 0.5) / steps);
    const double square = std::max(rho * rho + a * a + 2 * rho * a * cosine, 1e-30);
    sum.radius_deg.push_back(std::sqrt(square));
    sum.factor.push_back(a * (a + rho * cosine) / square / steps);
  }
  return sum;
}

SecondScatterer::SecondScatterer(const RadialWeight& first, const Disk& disk)
    : radius_deg_(Radii(first, disk)) {
  energy_.reserve(radius_deg_.size());
  if (disk.offset_deg == 0) {
    for (const double r : radius_deg_) {
      energy_.push_back(optics::EnergyInDisk(first, {disk.radius_deg, r}));
    }
    return;
  }
  const RadialTable table(first, disk.radius_deg, radius_deg_.back() + disk.offset_deg);
  const double near_deg = 2 * (disk.radius_deg + 4 * first.kernel().core_radius_deg);
  for (const double r : radius_deg_) {
    energy_.push_back(MeanAround(table, disk.offset_deg, r, near_deg));
  }
}

double SecondScatterer::EnergyInDisk(const RadialWeight& second) const {
  double sum = 0;
  double within = 0;
  for (size_t i = 1; i < radius_deg_.size(); ++i) {
    const double next = second.EnergyWithin(radius_deg_[i]);
    sum += (next - within) * 0.5 * (energy_[i - 1] + energy_[i]);
    within = next;
  }
  return sum + (1 - within) * energy_.back();
}

// By parts: what is between two radii counts with the mean of both energies.
EnergySum SecondScatterer::Sum() const {
  EnergySum sum;
  const size_t last = radius_deg_.size() - 1;
  for (size_t i = 1; i <= last; ++i) {
    sum.radius_deg.push_back(radius_deg_[i]);
    sum.factor.push_back(0.5 * (energy_[i - 1] - energy_[std::min(i + 1, last)]));
  }
  sum.radius_deg.push_back(std::numeric_limits<double>::infinity());
  sum.factor.push_back(energy_[last]);
  return sum;
}

}  // namespace eyebox::optics
