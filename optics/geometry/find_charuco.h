// Corners of a ChArUco board, which may be seen in part.
#ifndef EYEBOX_OPTICS_GEOMETRY_FIND_CHARUCO_H_
#define EYEBOX_OPTICS_GEOMETRY_FIND_CHARUCO_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/geometry/view_points.h"

namespace eyebox::optics {

// As OpenCV 4.6 draws it: markers in the white squares, numbered by rows from the upper left.
struct CharucoBoard {
  int columns = 0;  // squares, at least 3
  int rows = 0;     // squares, at least 3
  double square_mm = 0;
  double marker_mm = 0;  // smaller than the square
  int marker_bits = 4;   // 4, 5 or 6: the dictionaries DICT_nXn_250
};

// Corners by ID, in the board's plane from its upper left corner.
// Errors: InvalidArgument (a board that cannot be), FailedPrecondition (no markers, or most of
// them of a larger board, fewer than 6 corners, corners that do not lie as those of this board).
absl::StatusOr<ViewPoints> FindCharuco(const Image<double>& view, const CharucoBoard& board,
                                       std::string_view source);

// The board, black on white, `square_px` a square, without a margin.
// Errors: as above.
absl::StatusOr<Image<double>> DrawCharuco(const CharucoBoard& board, int square_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_FIND_CHARUCO_H_
