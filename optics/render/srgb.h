// The sRGB transfer function (IEC 61966-2-1; Murray, HDRP model, eq 3), on scalars. Relative errors
// below 1e-15.
#ifndef EYEBOX_OPTICS_RENDER_SRGB_H_
#define EYEBOX_OPTICS_RENDER_SRGB_H_

namespace eyebox::optics {

// s: encoded to linear. x / 12.92 up to 0.04045, ((x + 0.055) / 1.055)^2.4 above; continued with
// the same formula beyond 1, and as an odd function below 0. NaN stays NaN.
double SrgbToLinear(double encoded);

// s^-1, its inverse: the break is where the two branches of s meet in linear light, 0.0031308.
double LinearToSrgb(double linear);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_SRGB_H_
