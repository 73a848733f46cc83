#include "optics/render/material/facet_integral.h"

namespace eyebox::optics {
namespace {

constexpr int kNodes = 64;

// Roots of the Legendre polynomial by Newton's method from the usual cosine estimate.
std::array<UnitNode, kNodes> LegendreNodes() {
  std::array<UnitNode, kNodes> nodes;
  for (int i = 0; i < kNodes; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (kNodes + 0.5));
    double slope = 1;
    for (int step = 0; step < 8; ++step) {
      double below = 1;
      double value = x;
      for (int n = 2; n <= kNodes; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * below) / n;
        below = value;
        value = next;
      }
      slope = kNodes * (x * value - below) / (x * x - 1);
      x -= value / slope;
    }
    nodes[static_cast<size_t>(i)] = {(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)};
  }
  return nodes;
}

}  // namespace

const std::array<UnitNode, 64>& UnitNodes() {
  static const std::array<UnitNode, kNodes> nodes = LegendreNodes();
  return nodes;
}

}  // namespace eyebox::optics
