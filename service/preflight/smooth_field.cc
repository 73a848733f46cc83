#include "service/preflight/smooth_field.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace eyebox::service {
namespace {

constexpr int kOrders = 6;  // 0 to 5
constexpr int kLeastSide_px = 16;
constexpr double kSigmaPerMad = 1.4826;

using Basis = std::vector<std::vector<double>>;  // [order][pixel], orthonormal

// Gram-Schmidt on 1, t, t^2, ... at t from -1 to 1.
Basis OrthonormalPolynomials(int pixels) {
  Basis basis;
  for (int order = 0; order < kOrders; ++order) {
    std::vector<double> p(static_cast<size_t>(pixels));
    for (int i = 0; i < pixels; ++i) {
      p[static_cast<size_t>(i)] = std::pow(2.0 * i / (pixels - 1) - 1, order);
    }
    for (const std::vector<double>& q : basis) {
      const double along = std::inner_product(p.begin(), p.end(), q.begin(), 0.0);
      for (size_t i = 0; i < p.size(); ++i) p[i] -= along * q[i];
    }
    const double norm = std::sqrt(std::inner_product(p.begin(), p.end(), p.begin(), 0.0));
    for (double& value : p) value /= norm;
    basis.push_back(std::move(p));
  }
  return basis;
}

Image<double> Smooth(const Image<double>& image) {
  const ImageSize size = image.size();
  const Basis across = OrthonormalPolynomials(size.width_px);
  const Basis down = OrthonormalPolynomials(size.height_px);
  double coefficients[kOrders][kOrders] = {};  // [y order][x order]
  for (int y = 0; y < size.height_px; ++y) {
    const auto row = image.row(y);
    for (size_t i = 0; i < kOrders; ++i) {
      const double along = std::inner_product(row.begin(), row.end(), across[i].begin(), 0.0);
      for (size_t j = 0; j < kOrders; ++j) {
        coefficients[j][i] += along * down[j][static_cast<size_t>(y)];
      }
    }
  }
  Image<double> smooth(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (size_t i = 0; i < kOrders; ++i) {
      double factor = 0;
      for (size_t j = 0; j < kOrders; ++j) {
        factor += coefficients[j][i] * down[j][static_cast<size_t>(y)];
      }
      for (int x = 0; x < size.width_px; ++x) {
        smooth.at(x, y) += factor * across[i][static_cast<size_t>(x)];
      }
    }
  }
  return smooth;
}

void DropOutliers(Image<double>& texture) {
  std::vector<double> distances;
  for (const double value : texture.pixels()) distances.push_back(std::abs(value));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double limit = 5 * kSigmaPerMad * *middle;
  for (double& value : texture.pixels()) {
    if (!(std::abs(value) <= limit)) value = 0;
  }
}

}  // namespace

Image<double> RelativeTexture(const Image<double>& image) {
  if (std::min(image.size().width_px, image.size().height_px) < kLeastSide_px) return {};
  Image<double> texture = Smooth(image);
  for (size_t i = 0; i < texture.pixels().size(); ++i) {
    const double smooth = texture.pixels()[i];
    if (!(smooth > 0)) return {};
    texture.pixels()[i] = image.pixels()[i] / smooth - 1;
  }
  DropOutliers(texture);
  return texture;
}

}  // namespace eyebox::service
