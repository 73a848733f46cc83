// Dots of a regular grid, printed or displayed, in a view that may be strongly distorted.
#ifndef EYEBOX_OPTICS_GEOMETRY_FIND_DOTS_H_
#define EYEBOX_OPTICS_GEOMETRY_FIND_DOTS_H_

#include <string_view>
#include <vector>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/geometry/pixel_point.h"

namespace eyebox::optics {

struct DotGrid {
  int columns = 0;      // at least 3
  int rows = 0;         // at least 3
  bool bright = false;  // brighter than what surrounds them
};

struct Dot {
  int column = 0;  // from the left
  int row = 0;     // from the top, as the camera sees it: within 45 deg of upright
  PixelPoint centre;
};

// Centres of bright (or dark) spots that do not touch the border, in no order: centroids above a
// fifth of the contrast with what lies around. A disk seen at a slant has its centre of light off
// its centre by about f r^2 sin(2 tilt) / (2 d^2) (r its radius, d its distance): keep dots small.
std::vector<PixelPoint> FindSpots(const Image<double>& view, bool bright);

// Rows and columns of spots, by walking from neighbour to neighbour; bends are followed. A board
// that lies on its side (columns and rows exchanged) is taken as turned by 90 deg.
// Errors: FailedPrecondition (the spots make a grid of another size, or with gaps: says which, or
// none at all), InvalidArgument (fewer than 3 columns or rows).
absl::StatusOr<std::vector<Dot>> OrderDots(const std::vector<PixelPoint>& spots,
                                           const DotGrid& grid, std::string_view source);

// Both. `source` names the view in messages.
absl::StatusOr<std::vector<Dot>> FindDots(const Image<double>& view, const DotGrid& grid,
                                          std::string_view source);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_FIND_DOTS_H_
