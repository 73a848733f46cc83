// The mean over a square window of same-colour neighbours, invalid pixels left out.
#ifndef EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_
#define EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_

#include "capture/base/image.h"

namespace eyebox::optics {

// Window of (2 radius + 1)^2 pixels, `step_px` apart in x and y. NaN in `image` is left out; NaN in
// the result where the window holds nothing. [height, width].
Image<float> BoxMean(const Image<float>& image, int radius, int step_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_BOX_MEAN_H_
