#include "optics/sensor/tile_variance.h"

#include <algorithm>
#include <cmath>

#include "optics/sensor/median.h"

namespace eyebox::optics {
namespace {

constexpr int kTilePixels = 8;  // of one colour, along a side
constexpr size_t kTilesPerBin = 4096;
constexpr size_t kFewestTiles = 4;
constexpr double kFewestDifferences = 25;
// Mixed differences share pixels: their correlations 1/2 (four neighbours) and 1/4 (four more)
// leave n of them the information of n / (1 + 4/4 + 4/16).
constexpr double kSharingEfficiency = 4.0 / 9;
constexpr double kMedianEfficiency = 0.64;  // of the median against the mean

}  // namespace

struct TileVariances::Tile {
  double differences = 0;
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
  const int width = frame.size.width_px;
  const int height = frame.size.height_px;
  const auto usable = [&](size_t i) { return defects.empty() || defects.pixels()[i] == 0; };
  const auto measure = [&](int left, int top) {
    Tile tile;
    tile.bias_dn = bias_dn;
    for (int y = top; y < std::min(height, top + side); y += period) {
      for (int x = left; x < std::min(width, left + side); x += period) {
        const size_t here = static_cast<size_t>(y) * width + x;
        const double dn = frame.pixels_dn[here];
        if (!usable(here)) continue;
        tile.saturated |= dn >= saturation_dn;
        tile.count_sum_dn += dn;
        ++tile.pixels;
        if (x == left || y == top) continue;
        const size_t before = here - period;
        const size_t above = here - static_cast<size_t>(period) * width;
        const size_t both = above - period;
        if (!usable(before) || !usable(above) || !usable(both)) continue;
        const double difference =
            dn - frame.pixels_dn[before] - frame.pixels_dn[above] + frame.pixels_dn[both];
        ++tile.differences;
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
  const double variance = tile.difference_squares / (4 * tile.differences);
  const double mean_dn = tile.count_sum_dn / tile.pixels;
  if (mean_dn <= 1 || mean_dn * mean_dn <= 9 * variance) return;  // clipped at 0 DN
  const double signal_dn = mean_dn - tile.bias_dn;
  const double position = std::max(signal_dn, 0.0) / bin_width_dn_;
  if (!(position < static_cast<double>(bins_.size()))) return;
  Bin& bin = bins_[static_cast<size_t>(position)];
  if (bin.variances_dn2.size() >= kTilesPerBin) return;
  bin.variances_dn2.push_back(static_cast<float>(variance));
  bin.signal_sum_dn += signal_dn;
  bin.freedom_sum += tile.differences * kSharingEfficiency;
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
