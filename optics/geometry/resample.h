// A map over pixels as a map over field angles.
#ifndef EYEBOX_OPTICS_GEOMETRY_RESAMPLE_H_
#define EYEBOX_OPTICS_GEOMETRY_RESAMPLE_H_

#include "absl/status/statusor.h"
#include "capture/base/image.h"
#include "optics/geometry/entrance_pupil.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// A regular grid of field angles; cell (i, j) is centred on
// (left_deg + i step_deg, top_deg - j step_deg).
struct FieldGrid {
  double left_deg = 0;
  double top_deg = 0;
  double step_deg = 0;
  ImageSize size;  // columns to the right, rows downwards

  FieldAngle CentreOf(int column, int row) const;
  // Errors: InvalidArgument (no cells, more than 64 million, a step not above 0, angles of 90 deg
  // or more).
  absl::Status Validate() const;
};

// The grid of `step_deg` with a cell centred on (0, 0) that holds what the sensor sees, up to
// 80 deg. Errors: InvalidArgument (step not above 0), FailedPrecondition (it sees nothing there).
absl::StatusOr<FieldGrid> GridOver(const ViewGeometry& geometry, double step_deg);

struct FieldMap {
  FieldGrid grid;
  MeasuredImage image;           // [rows, columns] of the grid
  Image<double> solid_angle_sr;  // of the part of each cell that valid pixels cover
};

struct ResampleOptions {
  // A cell is valid if valid pixels cover at least this share of its solid angle.
  double least_coverage = 0.5;
};

// Each pixel is cut into parts of at most half a cell, and each part counts in the cell that holds
// it by its solid angle: values are means of the pixels in a cell, and the sum of value times solid
// angle over the cells is that over the pixels, exactly. Variances follow from the same weights;
// neighbouring cells that share a pixel share its noise. Pixels that are masked take no part; a
// cell without enough of the others has their flags, or kNoData.
// Errors: those of FieldGrid and CameraModel; InvalidArgument (another size than the camera's).
absl::StatusOr<FieldMap> ResampleToField(const MeasuredImage& image, const ViewGeometry& geometry,
                                         const FieldGrid& grid,
                                         const ResampleOptions& options = {});

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_RESAMPLE_H_
