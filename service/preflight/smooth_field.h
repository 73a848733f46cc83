// What is left of an image when everything smooth is taken out of it.
#ifndef EYEBOX_SERVICE_PREFLIGHT_SMOOTH_FIELD_H_
#define EYEBOX_SERVICE_PREFLIGHT_SMOOTH_FIELD_H_

#include "capture/base/image.h"

namespace eyebox::service {

// image / smooth - 1, [height, width], where smooth is the projection on products of polynomials up
// to order 5 in x and in y; values beyond 5 robust sigma (hot, dead pixels) become 0.
// Empty if the image has fewer than 16 columns or rows, or a smooth part that is not above 0.
Image<double> RelativeTexture(const Image<double>& image);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_SMOOTH_FIELD_H_
