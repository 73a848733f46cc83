// The Lit shaders of the Universal and of the High Definition Render Pipeline.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_LIT_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_LIT_H_

#include "optics/render/material/directions.h"
#include "optics/render/material/surface_split.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

// Lambert, and a highlight in which visibility and Fresnel are one cheap factor: pi f_s = f0 r^2 /
// (d^2 max(0.1, (l.h)^2) (4 r + 2)), d = (n.h)^2 (r^2 - 1) + 1.00001 (URP BRDF.hlsl,
// DirectBRDFSpecular). An irradiance of pi stands for a light of intensity 1.
struct UrpLit {
  Surface surface;

  // HALF_MIN_SQRT, 2^-7 (URP BRDF.hlsl): smoothness above 0.9116 has one highlight.
  static constexpr double kRoughnessFloor = 0.0078125;

  Rgb Reflected(const Directions& d) const;
  // diffuse + (f0 + (grazing - f0) (1 - n.v)^4) / (r^2 + 1) (URP BRDF.hlsl, EnvironmentBRDF).
  Rgb AmbientReflected(double n_v) const;
};

// Disney diffuse over 1.03571, GGX with exact Smith and Schlick (HDRP Lit.hlsl, core BSDF.hlsl).
// Irradiance in lux. The shader holds n.v above 1e-4; here its limit is exact.
struct HdrpLit {
  Surface surface;
  // What facets lose to each other is given back, as the shader does by default: the highlight
  // times 1 + f0 (1 / E(n.v) - 1), E what a white highlight reflects. As only the eye's side is
  // looked up, this makes the model one-way (not reciprocal).
  bool energy_compensation = true;

  // ClampRoughnessForAnalyticalLights, 1/1024 (core CommonMaterial.hlsl): smoothness above 0.96875
  // has one highlight.
  static constexpr double kRoughnessFloor = 1.0 / 1024;
  static constexpr double kDisneyScale = 1 / 1.03571;

  Rgb Reflected(const Directions& d) const { return Reflected(d, Compensation(d.n_v)); }
  // With the compensation of its n.v, which one view shares for all lights.
  Rgb Reflected(const Directions& d, const Rgb& compensation) const;
  // {1, 1, 1} without compensation or highlight. Takes an integral over facets.
  Rgb Compensation(double n_v) const;
  // What the shader's pre-integrated tables hold, for a uniform surround; relative error below
  // 1e-3.
  Rgb AmbientReflected(double n_v) const;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_LIT_H_
