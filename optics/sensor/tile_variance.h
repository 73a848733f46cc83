// Noise from single frames: how neighbours of one colour differ.
#ifndef EYEBOX_OPTICS_SENSOR_TILE_VARIANCE_H_
#define EYEBOX_OPTICS_SENSOR_TILE_VARIANCE_H_

#include <cstdint>
#include <vector>

#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/variance_line.h"

namespace eyebox::optics {

// Collects, per tile of 8 x 8 same-colour pixels, a quarter of the mean square of the mixed second
// differences of neighbours (a gradient in any direction and an edge along a row or a column
// cancel), by the tile's mean signal. The median over the tiles of a bin ignores the few that hold
// an edge. It still contains the sensor's nonuniformity and fine texture, whose variance grows with
// the square of the signal: FitTexturedVarianceLine tells them apart. Memory: at most 4096 tiles a
// bin.
class TileVariances {
 public:
  // Bins of equal width from 0 to `upper_signal_dn`; same-colour neighbours are
  // `colour_period_px` apart.
  TileVariances(int bins, double upper_signal_dn, int colour_period_px);

  // Signal is the count less `bias_dn`. Tiles with a count at or above `saturation_dn`, or within
  // noise of 0 DN, are left out; so are pixels where `defects` is not 0 (it may be empty).
  void Add(const FrameView& frame, double bias_dn, double saturation_dn,
           const Image<uint8_t>& defects);

  // One point for each bin of at least 4 tiles.
  std::vector<PhotonTransferPoint> Points() const;

 private:
  struct Bin {
    std::vector<float> variances_dn2;
    double signal_sum_dn = 0;
    double freedom_sum = 0;
  };
  struct Tile;
  void AddTile(const Tile& tile);

  std::vector<Bin> bins_;
  double bin_width_dn_;
  int colour_period_px_;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SENSOR_TILE_VARIANCE_H_
