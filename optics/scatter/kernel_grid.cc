#include "optics/scatter/kernel_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace eyebox::optics {
namespace {

constexpr int kNearPx = 24;      // beyond, the middle of a pixel stands for its mean to 1e-3
constexpr int kNearestPx = 256;  // however wide the core: it is smooth by then
constexpr double kNearCores = 8;

// Gauss-Legendre, 8 points on [-1, 1].
constexpr std::array<double, 4> kNodes = {0.1834346424956498, 0.5255324099163290,
                                          0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> kWeights = {0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};

// Energy that passes the pixel edge at x = distance, y in [middle - pitch/2, middle + pitch/2], as
// seen from the axis: the flux of E(s) / (2 pi s^2) (x, y), whose divergence is w.
double EdgeFlux(const RadialWeight& weight, double distance, double middle, double pitch) {
  double sum = 0;
  for (size_t k = 0; k < kNodes.size(); ++k) {
    for (const double sign : {-1.0, 1.0}) {
      const double y = middle + sign * kNodes[k] * pitch / 2;
      const double square = distance * distance + y * y;
      sum += kWeights[k] * weight.EnergyWithin(std::sqrt(square)) / square;
    }
  }
  return sum * distance * pitch / (4 * std::numbers::pi);
}

int Copies(int x, int y) { return (x > 0 ? 2 : 1) * (y > 0 ? 2 : 1); }

int NearSize(const RadialWeight& weight, double pitch) {
  const double core = kNearCores * weight.kernel().core_radius_deg / pitch;
  return std::max(kNearPx, static_cast<int>(std::min<double>(std::ceil(core), kNearestPx)));
}

// Pixels of the square nearest to the axis: what passes their four edges.
void IntegrateNear(const RadialWeight& weight, double pitch, int size, Image<float>& grid) {
  // flux[m * size + j]: edge at (m + 1/2) pitch, its middle at j pitch.
  std::vector<double> flux(static_cast<size_t>(size) * size);
  for (int m = 0; m < size; ++m) {
    for (int j = 0; j < size; ++j) {
      flux[static_cast<size_t>(m) * size + j] =
          EdgeFlux(weight, (m + 0.5) * pitch, j * pitch, pitch);
    }
  }
  const auto net = [&](int along, int across) {
    const double outer = flux[static_cast<size_t>(along) * size + across];
    // The pixel on the axis has two outer edges.
    return along == 0 ? 2 * outer : outer - flux[static_cast<size_t>(along - 1) * size + across];
  };
  for (int y = 0; y < std::min(size, grid.size().height_px); ++y) {
    for (int x = 0; x < std::min(size, grid.size().width_px); ++x) {
      grid.at(x, y) = static_cast<float>(std::max(net(x, y) + net(y, x), 0.0));
    }
  }
}

double EnergyOfRectangle(const RadialWeight& weight, double pitch, ImageSize quadrant) {
  const auto passes = [&](int along, int across) {
    double sum = 0;
    for (int j = 0; j < across; ++j) {
      sum += (j > 0 ? 4 : 2) * EdgeFlux(weight, (along - 0.5) * pitch, j * pitch, pitch);
    }
    return sum;
  };
  return passes(quadrant.width_px, quadrant.height_px) +
         passes(quadrant.height_px, quadrant.width_px);
}

// Density in the middle of the pixel, all scaled so that the whole has the energy it must have.
void SampleFar(const RadialWeight& weight, double pitch, int near, Image<float>& grid) {
  const auto [width, height] = grid.size();
  const double target = EnergyOfRectangle(weight, pitch, grid.size()) - SumOverGrid(grid);
  double sum = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = y < near ? near : 0; x < width; ++x) {
      const double density = weight.Density(std::hypot(x * pitch, y * pitch)) * pitch * pitch;
      grid.at(x, y) = static_cast<float>(density);
      sum += Copies(x, y) * density;
    }
  }
  // Where next to nothing is left, target and sum differ by rounding only.
  const auto scale = static_cast<float>(std::clamp(sum > 0 ? target / sum : 1.0, 0.0, 2.0));
  for (int y = 0; y < height; ++y) {
    for (int x = y < near ? near : 0; x < width; ++x) grid.at(x, y) *= scale;
  }
}

}  // namespace

Image<float> SampleKernel(const RadialWeight& weight, double pitch_deg, ImageSize quadrant) {
  Image<float> grid(quadrant);
  const int near =
      std::min(NearSize(weight, pitch_deg), std::max(quadrant.width_px, quadrant.height_px));
  IntegrateNear(weight, pitch_deg, near, grid);
  if (quadrant.width_px > near || quadrant.height_px > near) {
    SampleFar(weight, pitch_deg, near, grid);
  }
  return grid;
}

double SumOverGrid(const Image<float>& quadrant) {
  double sum = 0;
  for (int y = 0; y < quadrant.size().height_px; ++y) {
    for (int x = 0; x < quadrant.size().width_px; ++x)
      sum += Copies(x, y) * static_cast<double>(quadrant.at(x, y));
  }
  return sum;
}

}  // namespace eyebox::optics
