// The Standard shader of Unity's built-in pipeline.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_STANDARD_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_STANDARD_H_

#include "optics/render/material/directions.h"
#include "optics/render/material/surface_split.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

enum class SmithForm {
  kExact,   // as documented (Kyselka section 3.2.2)
  kShader,  // what UnityStandardBRDF.cginc computes instead of the square roots
};

// f_r = diffuse Disney / pi + F D V, D of GGX, F of Schlick at l.h, V of Smith (Kyselka section
// 3.2.2, whose G / 4 is this V). An irradiance of pi stands for a light of intensity 1. Relative
// error below 1e-14 with kExact.
struct Standard {
  Surface surface;
  SmithForm smith = SmithForm::kExact;
  // Gamma mode: all colours are encoded ones, the dielectric f0 is 0.2209, and the highlight's pi D
  // V becomes its square root, not below 0.01 (UnityStandardBRDF.cginc).
  bool gamma_mode = false;

  // The shader's own clamp (UnityStandardBRDF.cginc): smoothness above 0.9553 has one highlight.
  static constexpr double kRoughnessFloor = 0.002;

  SurfaceSplit Split() const;
  Rgb Reflected(const Directions& d) const;
  // As the shader approximates it for a surround without detail: diffuse + (f0 + (grazing - f0) (1
  // - n.v)^5) surfaceReduction, grazing = min(smoothness + reflectivity, 1), surfaceReduction =
  // 1 / (roughness^2 + 1), in Gamma mode 1 - 0.28 roughness (1 - smoothness).
  Rgb AmbientReflected(double n_v) const;

 private:
  double Highlight(const Directions& d) const;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_STANDARD_H_
