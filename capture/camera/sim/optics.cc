#include "capture/camera/sim/optics.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

namespace eyebox::capture {
namespace {

double Squared(double x) { return x * x; }

// Adds weight * shape(r^2), scaled so that what is added sums to `weight`.
template <typename Shape>
void AddRadial(Image<double>& kernel, double weight, Shape shape) {
  const int radius = kernel.size().width_px / 2;
  Image<double> part(kernel.size());
  double sum = 0;
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      const double r2 = Squared(x) + Squared(y);
      if (r2 > Squared(radius)) continue;
      sum += part.at(x + radius, y + radius) = shape(r2);
    }
  }
  for (size_t i = 0; i < part.pixels().size(); ++i) {
    kernel.pixels()[i] += weight / sum * part.pixels()[i];
  }
}

int KernelRadius(const ScatterParameters& parameters) {
  const int core = static_cast<int>(std::ceil(6 * parameters.core_sigma_px));
  return parameters.tail_weight > 0 ? std::max(core, parameters.tail_radius_px) : core;
}

// The scene with its border repeated `radius` pixels outwards, on a canvas of `canvas` pixels.
cv::Mat1d PaddedScene(const Image<double>& scene, int radius, cv::Size canvas) {
  const auto [width, height] = scene.size();
  cv::Mat1d padded(canvas, 0.0);
  for (int y = 0; y < height + 2 * radius; ++y) {
    const int source_y = std::clamp(y - radius, 0, height - 1);
    for (int x = 0; x < width + 2 * radius; ++x) {
      padded(y, x) = scene.at(std::clamp(x - radius, 0, width - 1), source_y);
    }
  }
  return padded;
}

// The kernel with its centre at the origin of a periodic canvas.
cv::Mat1d WrappedKernel(const Image<double>& kernel, cv::Size canvas) {
  const int radius = kernel.size().width_px / 2;
  cv::Mat1d wrapped(canvas, 0.0);
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      wrapped((y + canvas.height) % canvas.height, (x + canvas.width) % canvas.width) =
          kernel.at(x + radius, y + radius);
    }
  }
  return wrapped;
}

Image<double> ConvolveByFourier(const Image<double>& scene, const Image<double>& kernel) {
  const auto [width, height] = scene.size();
  const int radius = kernel.size().width_px / 2;
  const cv::Size canvas(cv::getOptimalDFTSize(width + 2 * radius),
                        cv::getOptimalDFTSize(height + 2 * radius));
  cv::Mat1d light = PaddedScene(scene, radius, canvas);
  cv::Mat1d weight = WrappedKernel(kernel, canvas);
  cv::dft(light, light);
  cv::dft(weight, weight);
  cv::mulSpectrums(light, weight, light, 0);
  cv::dft(light, light, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  Image<double> scattered(scene.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) scattered.at(x, y) = light(y + radius, x + radius);
  }
  return scattered;
}

}  // namespace

Image<double> ScatterKernel(const ScatterParameters& parameters) {
  const int radius = KernelRadius(parameters);
  Image<double> kernel({.width_px = 2 * radius + 1, .height_px = 2 * radius + 1});
  const double core_weight = 1 - parameters.tail_weight;
  if (parameters.core_sigma_px > 0) {
    const double scale = -0.5 / Squared(parameters.core_sigma_px);
    AddRadial(kernel, core_weight, [scale](double r2) { return std::exp(scale * r2); });
  } else {
    kernel.at(radius, radius) = core_weight;
  }
  if (parameters.tail_weight > 0) {
    const double scale = 1 / Squared(parameters.tail_scale_px);
    AddRadial(kernel, parameters.tail_weight, [&parameters, scale](double r2) {
      return std::pow(1 + scale * r2, -parameters.tail_beta);
    });
  }
  return kernel;
}

absl::StatusOr<Image<double>> Scatter(const Image<double>& scene,
                                      const ScatterParameters& parameters) {
  if (parameters.core_sigma_px == 0 && parameters.tail_weight == 0) return scene;
  try {
    return ConvolveByFourier(scene, ScatterKernel(parameters));
  } catch (const cv::Exception& error) {
    return absl::InternalError("sim scatter: OpenCV refused the convolution: " + error.msg);
  }
}

Image<double> Vignetting(const PinholeGeometry& geometry, ImageSize size) {
  Image<double> cos4(size);
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      const double tan2 =
          (Squared(x - geometry.principal_x_px) + Squared(y - geometry.principal_y_px)) /
          Squared(geometry.focal_length_px);
      cos4.at(x, y) = 1 / Squared(1 + tan2);
    }
  }
  return cos4;
}

}  // namespace eyebox::capture
