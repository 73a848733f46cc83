// Lines of equal value over a map, for whoever wants to draw them.
#ifndef EYEBOX_SERVICE_RESULTS_CONTOURS_H_
#define EYEBOX_SERVICE_RESULTS_CONTOURS_H_

#include <span>
#include <vector>

#include "capture/base/image.h"
#include "eyebox/v1/uniformity.pb.h"
#include "optics/uniformity/uniformity_map.h"

namespace eyebox::service {

// A step of 1, 2 or 5 times a power of ten that gives about eight lines; none over a flat range.
std::vector<double> ContourLevels(const optics::FieldRange& range);

// Marching squares on cells of pixels, at most 96 along the longer side, joined to lines. A closed
// line ends where it began. NaN cells have none.
std::vector<v1::ContourLine> ContourLines(const Image<float>& map, std::span<const double> levels);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_CONTOURS_H_
