// The colours of a map: viridis (van der Walt & Smith 2015, CC0), even in perceived lightness and
// legible in grey print and to colour-blind readers.
#ifndef EYEBOX_SERVICE_REPORT_COLOUR_MAP_H_
#define EYEBOX_SERVICE_REPORT_COLOUR_MAP_H_

#include "capture/base/image.h"
#include "capture/base/image_file.h"
#include "service/report/report.h"

namespace eyebox::service::report {

// Where there is no value: a grey that the map does not contain.
inline constexpr Rgb8 kInvalidColour = {200, 200, 200};

// `fraction` in [0, 1], clamped.
Rgb8 Viridis(double fraction);

// NaN becomes kInvalidColour; values beyond `range` take the colour of its end.
Image<Rgb8> Coloured(const Image<float>& map, Range range);

}  // namespace eyebox::service::report

#endif  // EYEBOX_SERVICE_REPORT_COLOUR_MAP_H_
