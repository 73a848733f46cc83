#include "optics/sensor/tile_variance.h"

#include <algorithm>
#include <cmath>

#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr int kTilePixels = 16;  // of one colour, along a side
constexpr size_t kTilesPerBin = 4096;
constexpr size_t kFewestTiles = 4;
constexpr double kFewestDifferences = 100;
// Differences of a chain share pixels: n of them hold the information of about 2 n / 3.
constexpr double kChainEfficiency = 2.0 / 3;
constexpr double kMedianEfficiency = 0.64;  // of the median against the mean

}  // namespace

struct TileVariances::Tile {
  double differences = 0;
  double difference_sum = 0;
  double difference_squares = 0;
  double count_sum_dn = 0;
  double pixels = 0;
  bool saturated = false;
  double bias_dn = 0;
};

TileVariances::TileVariances(int bins, double upper_signal_dn, int colour_period_px)
    : bins_(bins), bin_width_dn_(upper_signal_dn / bins), colour_period_px_(colour_period_px) {}

void TileVariances::Add(const FrameView& frame, double bias_dn, double saturation_dn,
                        const Image<uint8_t>& defects) {
  const int period = colour_period_px_;
  const int side = kTilePixels * period;
  const auto [width, height] = frame.size;
  const auto usable = [&](size_t i) { return defects.empty() || defects.pixels()[i] == 0; };
  const auto measure = [&](int left, int top) {
    Tile tile;
    tile.bias_dn = bias_dn;
    for (int y = top; y < std::min(height, top + side); y += period) {
      const size_t row = static_cast<size_t>(y) * width;
      for (int x = left; x < std::min(width, left + side); x += period) {
        const double dn = frame.pixels_dn[row + x];
        if (!usable(row + x)) continue;
        tile.saturated |= dn >= saturation_dn;
        tile.count_sum_dn += dn;
        ++tile.pixels;
        if (x == left || !usable(row + x - period)) continue;
        const double difference = dn - frame.pixels_dn[row + x - period];
        ++tile.differences;
        tile.difference_sum += difference;
        tile.difference_squares += difference * difference;
      }
    }
    AddTile(tile);
  };
  for (int top = 0; top < height; top += side) {
    for (int left = 0; left < width; left += side) {
      for (int phase = 0; phase < period * period; ++phase) {
        measure(left + phase % period, top + phase / period);
      }
    }
  }
}

void TileVariances::AddTile(const Tile& tile) {
  if (tile.saturated || tile.differences < kFewestDifferences) return;
  const double n = tile.differences;
  const double variance =
      0.5 * (tile.difference_squares - tile.difference_sum * tile.difference_sum / n) / (n - 1);
  const double mean_dn = tile.count_sum_dn / tile.pixels;
  if (mean_dn <= 1 || mean_dn * mean_dn <= 9 * variance) return;  // clipped at 0 DN
  const double signal_dn = mean_dn - tile.bias_dn;
  const double position = std::max(signal_dn, 0.0) / bin_width_dn_;
  if (!(position < static_cast<double>(bins_.size()))) return;
  Bin& bin = bins_[static_cast<size_t>(position)];
  if (bin.variances_dn2.size() >= kTilesPerBin) return;
  bin.variances_dn2.push_back(static_cast<float>(variance));
  bin.signal_sum_dn += signal_dn;
  bin.freedom_sum += n * kChainEfficiency;
}

std::vector<PhotonTransferPoint> TileVariances::Points() const {
  std::vector<PhotonTransferPoint> points;
  for (const Bin& bin : bins_) {
    const size_t tiles = bin.variances_dn2.size();
    if (tiles < kFewestTiles) continue;
    points.push_back({bin.signal_sum_dn / static_cast<double>(tiles), Median(bin.variances_dn2),
                      kMedianEfficiency * bin.freedom_sum});
  }
  return points;
}

}  // namespace eyebox::optics
