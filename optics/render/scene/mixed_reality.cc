#include "optics/render/scene/mixed_reality.h"

#include <algorithm>
#include <cmath>

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

Rgb TimesMatrix(const Rgb& row, const Matrix3& matrix) {
  Rgb product = {};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) product[k] += row[i] * matrix[i][k];
  }
  return product;
}

Rgb Cut(const Rgb& colour, double top) {
  Rgb cut = {};
  for (size_t k = 0; k < 3; ++k) cut[k] = colour[k] > 0 ? std::min(colour[k], top) : 0;
  return cut;
}

}  // namespace

double SaturatingLuminance(const PassThroughCamera& camera) {
  return std::exp2(camera.ev) * camera.calibration_constant;
}

double EvSaturatingAt(double luminance_cd_m2, double calibration_constant) {
  return std::log2(luminance_cd_m2 / calibration_constant);
}

double MatchingExposure(const PassThroughCamera& camera, double rendering_constant) {
  return camera.ev + std::log2(camera.calibration_constant * rendering_constant);
}

double EvFromGain(double gain) { return std::log2(gain); }
double GainFromEv(double ev) { return std::exp2(ev); }
double Ev100FromGain(double gain) { return -std::log2(gain / 100); }
double GainFromEv100(double ev100) { return 100 * std::exp2(-ev100); }

double CubemapLuminance(double value) { return kCubemapUnitCdPerM2 * value; }
double CubemapValue(double luminance_cd_m2) { return luminance_cd_m2 / kCubemapUnitCdPerM2; }

Rgb BalanceWhite(const Rgb& colour, const WhiteBalance& balance, int bits) {
  const double top = std::exp2(bits) - 1;
  const Rgb sensor = Cut(TimesMatrix(colour, balance.inverse_ccm) * balance.gains, top);
  return Cut(TimesMatrix(sensor, balance.ccm), top);
}

}  // namespace eyebox::optics
