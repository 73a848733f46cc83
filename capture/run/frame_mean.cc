#include "capture/run/frame_mean.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace eyebox::capture {
namespace {

constexpr size_t kEnoughPixels = size_t{1} << 18;
constexpr double kQuantisationVariance = 1.0 / 12;

// Odd, so that both kinds of row of a mosaic take part.
size_t RowStep(ImageSize size) { return size.PixelCount() / kEnoughPixels | 1; }

struct Sums {
  uint64_t pixels = 0;
  uint64_t counts = 0;
  uint64_t pairs = 0;
  uint64_t squares = 0;  // of differences of neighbours two apart: of one colour in a mosaic
};

void AddRow(const uint16_t* row, size_t width, Sums& sums) {
  uint64_t counts = 0;
  uint64_t squares = 0;
  for (size_t x = 0; x < width; ++x) counts += row[x];
  for (size_t x = 2; x < width; ++x) {
    const int64_t difference = int64_t{row[x]} - row[x - 2];
    squares += static_cast<uint64_t>(difference * difference);
  }
  sums.pixels += width;
  sums.counts += counts;
  sums.pairs += width > 2 ? width - 2 : 0;
  sums.squares += squares;
}

}  // namespace

FrameMean MeanOf(const FrameView& frame) {
  Sums sums;
  const auto width = static_cast<size_t>(frame.size.width_px);
  const size_t step = RowStep(frame.size) * width;
  if (width == 0) return {};
  for (size_t at = 0; at + width <= frame.pixels_dn.size(); at += step) {
    AddRow(frame.pixels_dn.data() + at, width, sums);
  }
  if (sums.pixels == 0) return {};
  const auto pixels = static_cast<double>(sums.pixels);
  const double scatter =
      sums.pairs == 0 ? 0
                      : static_cast<double>(sums.squares) / (2 * static_cast<double>(sums.pairs));
  const double sigma = std::sqrt(std::max(scatter, kQuantisationVariance) / pixels);
  return {
      .mean_dn = static_cast<double>(sums.counts) / pixels, .sigma_dn = sigma, .noise_dn = sigma};
}

FrameMean MeanOf(const std::vector<FrameMean>& frames) {
  const auto count = static_cast<double>(frames.size());
  double sum = 0;
  double variance = 0;
  for (const FrameMean& frame : frames) {
    sum += frame.mean_dn;
    variance += frame.noise_dn * frame.noise_dn;
  }
  const double mean = sum / count;
  double squares = 0;
  for (const FrameMean& frame : frames) squares += std::pow(frame.mean_dn - mean, 2);
  const double scatter = frames.size() < 2 ? 0 : std::sqrt(squares / (count - 1) / count);
  const double noise = std::sqrt(variance) / count;
  return {.mean_dn = mean, .sigma_dn = std::max(noise, scatter), .noise_dn = noise};
}

}  // namespace eyebox::capture
