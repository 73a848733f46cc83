// How Unity splits a surface's colour into diffuse and specular, and turns smoothness to roughness.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_SURFACE_SPLIT_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_SURFACE_SPLIT_H_

#include <optional>

#include "optics/render/rgb.h"

namespace eyebox::optics {

// Reflectance of dielectrics at normal incidence: unity_ColorSpaceDielectricSpec, 0.04 in Linear
// mode (URP and HDRP too) and its encoded value in Gamma mode (UnityCG.cginc).
constexpr double kDielectricSpecular = 0.04;
constexpr double kDielectricSpecularGamma = 0.220916301;

// The surface inputs that Standard, URP Lit and HDRP Lit share (Kyselka, table 4.2). Colours are
// scene-linear, in [0, 1].
struct Surface {
  Rgb base = {1, 1, 1};
  double metallic = 0;          // in [0, 1]; not looked at in the specular set-up
  std::optional<Rgb> specular;  // the specular set-up where given
  double smoothness = 0.5;      // in [0, 1]

  // Perceptual roughness, 1 - smoothness (Kyselka section 3.2.2).
  double PerceptualRoughness() const { return 1 - smoothness; }
  // Its square, not below `floor`. A smoothness of 1 would be a mirror, in which a light without
  // extent shows nothing or everything; each shader holds its roughness above a floor instead.
  double Roughness(double floor) const;
};

struct SurfaceSplit {
  Rgb diffuse;
  Rgb specular;             // f0
  double reflectivity = 0;  // 1 minus what the diffuse part was scaled with
};

// Standard and URP Lit: f0 from `dielectric` to the base colour with metallic, diffuse scaled with
// (1 - dielectric)(1 - metallic); in the specular set-up diffuse is scaled with 1 - max(specular).
SurfaceSplit SplitSurface(const Surface& surface, double dielectric);

// HDRP Lit: the diffuse part is scaled with 1 - metallic alone (Lit.hlsl, ComputeDiffuseColor).
SurfaceSplit SplitSurfaceHdrp(const Surface& surface);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_SURFACE_SPLIT_H_
