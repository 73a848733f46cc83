// Maps made small enough for a page, and the lines of equal value in them.
#ifndef EYEBOX_SERVICE_REPORT_RASTER_H_
#define EYEBOX_SERVICE_REPORT_RASTER_H_

#include <optional>
#include <span>
#include <vector>

#include "capture/base/image.h"
#include "service/report/report.h"
#include "service/report/svg.h"

namespace eyebox::service::report {

// Means of blocks of k x k pixels over their valid values (NaN where there is none), k the smallest
// that brings both sides to `longest_side` or below. Blocks at the right and lower rim may be cut.
Image<float> Shrunk(std::span<const float> values, ImageSize size, int longest_side);

// k of Shrunk.
int BlockSize(ImageSize size, int longest_side);

// nullopt if every value is NaN.
std::optional<Range> RangeOf(std::span<const float> values);

// Marching squares between cell centres, in units of cells (the centre of cell 0 is 0.5); cells
// beside an invalid one have no line.
std::vector<Segment> Contour(const Image<float>& map, double level);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_RASTER_H_
