// The axis on which HDRP samples its grading table: ALEXA LogC, EI 1000, cut to [0, 1].
#ifndef EYEBOX_OPTICS_RENDER_LOG_C_H_
#define EYEBOX_OPTICS_RENDER_LOG_C_H_

namespace eyebox::optics {

// 0.244161 log10(5.555556 u + 0.047996) + 0.386036, cut to [0, 1]: 0 for u <= -0.00392, 1 for
// u >= 58.85666. Entry i of a table of n lies at i / (n - 1), and between entries the shader
// interpolates linearly on this axis, not in u. Absolute error below 1e-15. NaN stays NaN.
double LinearToLogC(double u);

// Its inverse over [0, 1]; the lowest values belong to slightly negative u, which no scene has.
// Error below 1e-14 of u + 0.00864, which is the argument of the logarithm over 5.555556.
double LogCToLinear(double log_c);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_LOG_C_H_
