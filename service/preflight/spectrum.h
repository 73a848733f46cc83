// The power of an image over spatial frequency.
#ifndef EYEBOX_SERVICE_PREFLIGHT_SPECTRUM_H_
#define EYEBOX_SERVICE_PREFLIGHT_SPECTRUM_H_

#include "capture/base/image.h"

namespace eyebox::service {

// Power of the Hann-windowed image, [height, width / 2 + 1]: column kx is kx / width cycles per px,
// row ky is ky / height, those above height / 2 the negative ones. A wave of amplitude a on a
// frequency of the grid has power a^2. Plain sums over rows, then columns: any size, O(n^3), meant
// for a few hundred pixels a side. `image` has 2 rows and columns at least.
Image<double> PowerSpectrum(const Image<double>& image);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_SPECTRUM_H_
