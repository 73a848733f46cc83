// Rendered light beside filmed light: what the pass-through video of a mixed-reality headset shows,
// and how a renderer is set to agree with it (Varjo, "Creating realistic MR lighting").
#ifndef EYEBOX_OPTICS_RENDER_SCENE_MIXED_REALITY_H_
#define EYEBOX_OPTICS_RENDER_SCENE_MIXED_REALITY_H_

#include <array>

#include "optics/render/rgb.h"

namespace eyebox::optics {

// The cameras' settings of a moment, from the stream's metadata.
struct PassThroughCamera {
  double ev = 0;                    // exposure value
  double calibration_constant = 1;  // cameraCalibrationConstant, cd/m2, above 0
};

// The luminance that saturates a pixel of the video: 2^ev times the calibration constant.
double SaturatingLuminance(const PassThroughCamera& camera);
// The exposure value at which `luminance_cd_m2` > 0 just saturates.
double EvSaturatingAt(double luminance_cd_m2, double calibration_constant);

// The fixed exposure e at which a renderer with u = c L / 2^e shows a luminance of L cd/m2 just as
// the video does, 1 where it saturates: log2(c) + log2(SaturatingLuminance). `rendering_constant`
// > 0 is c.
double MatchingExposure(const PassThroughCamera& camera, double rendering_constant);

// brightnessNormalizationGain > 0 of the environment cubemap as a shift in EV, log2(gain), and as
// EV100, -log2(gain / 100); and back.
double EvFromGain(double gain);
double GainFromEv(double ev);
double Ev100FromGain(double gain);
double GainFromEv100(double ev100);

// The environment cubemap holds luminance as 1 for 100 cd/m2.
constexpr double kCubemapUnitCdPerM2 = 100;
double CubemapLuminance(double value);
double CubemapValue(double luminance_cd_m2);

// Row-major; colours are row vectors, multiplied from the left.
using Matrix3 = std::array<std::array<double, 3>, 3>;

struct WhiteBalance {
  Matrix3 inverse_ccm = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Rgb gains = {1, 1, 1};
  Matrix3 ccm = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

// saturate(saturate(colour invCCM diag(gains)) ccm): a colour rendered under 6500 K as the video's
// white balance would show it. Colour in codes of `bits` (1 to 16) bits, saturate cuts to [0,
// 2^bits - 1], and nothing is rounded. A colour with NaN becomes black.
Rgb BalanceWhite(const Rgb& colour, const WhiteBalance& balance, int bits);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_SCENE_MIXED_REALITY_H_
