#include "service/preflight/spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

namespace eyebox::service {
namespace {

using Complex = std::complex<double>;

std::vector<double> Hann(int pixels) {
  std::vector<double> window(static_cast<size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    window[static_cast<size_t>(i)] =
        0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 0.5) / pixels);
  }
  return window;
}

std::vector<Complex> Turns(int pixels) {
  std::vector<Complex> turns(static_cast<size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    turns[static_cast<size_t>(i)] = std::polar(1.0, -2 * std::numbers::pi * i / pixels);
  }
  return turns;
}

double Sum(const std::vector<double>& window) {
  return std::accumulate(window.begin(), window.end(), 0.0);
}

// Each row's transform, window included, [height, width / 2 + 1].
Image<Complex> TransformRows(const Image<double>& image, const std::vector<double>& across,
                             const std::vector<double>& down) {
  const ImageSize size = image.size();
  const std::vector<Complex> turns = Turns(size.width_px);
  const int columns = size.width_px / 2 + 1;
  Image<Complex> rows({.width_px = columns, .height_px = size.height_px});
  for (int y = 0; y < size.height_px; ++y) {
    const auto row = image.row(y);
    for (int kx = 0; kx < columns; ++kx) {
      Complex sum = 0;
      size_t turn = 0;
      for (size_t x = 0; x < row.size(); ++x) {
        sum += row[x] * across[x] * turns[turn];
        turn += static_cast<size_t>(kx);
        if (turn >= turns.size()) turn -= turns.size();
      }
      rows.at(kx, y) = sum * down[static_cast<size_t>(y)];
    }
  }
  return rows;
}

}  // namespace

Image<double> PowerSpectrum(const Image<double>& image) {
  const ImageSize size = image.size();
  const std::vector<double> across = Hann(size.width_px);
  const std::vector<double> down = Hann(size.height_px);
  const Image<Complex> rows = TransformRows(image, across, down);
  const std::vector<Complex> turns = Turns(size.height_px);
  const int columns = rows.size().width_px;
  // A wave of amplitude a shares its transform between two frequencies, a / 2 each.
  const double scale = std::pow(2 / (Sum(across) * Sum(down)), 2);
  Image<double> power(rows.size());
  std::vector<Complex> sums(static_cast<size_t>(columns));
  for (int ky = 0; ky < size.height_px; ++ky) {
    std::fill(sums.begin(), sums.end(), Complex(0));
    for (int y = 0; y < size.height_px; ++y) {
      const auto turn = static_cast<size_t>(static_cast<int64_t>(ky) * y % size.height_px);
      for (int kx = 0; kx < columns; ++kx) {
        sums[static_cast<size_t>(kx)] += rows.at(kx, y) * turns[turn];
      }
    }
    for (int kx = 0; kx < columns; ++kx) {
      power.at(kx, ky) = scale * std::norm(sums[static_cast<size_t>(kx)]);
    }
  }
  return power;
}

}  // namespace eyebox::service
