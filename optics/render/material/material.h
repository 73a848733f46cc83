// Any material that reflects light, and what may be relied on about it.
#ifndef EYEBOX_OPTICS_RENDER_MATERIAL_MATERIAL_H_
#define EYEBOX_OPTICS_RENDER_MATERIAL_MATERIAL_H_

#include <string_view>
#include <variant>

#include "optics/render/material/classic.h"
#include "optics/render/material/cook_torrance.h"
#include "optics/render/material/lit.h"
#include "optics/render/material/standard.h"

namespace eyebox::optics {

using LitMaterial =
    std::variant<Lambert, Phong, BlinnPhong, CookTorrance, Standard, UrpLit, HdrpLit>;

// "lambert", "phong", "blinn_phong", "cook_torrance", "standard", "urp_lit", "hdrp_lit".
std::string_view NameOf(const LitMaterial& material);

// What of the light is reflected at all: parts that are black are never computed.
struct Lobes {
  bool diffuse = false;
  bool specular = false;
};
Lobes LobesOf(const LitMaterial& material);

// What holds for every pair of directions with these settings, up to rounding. Measured, with the
// excess of those that do not claim it, by tests/tools/brdf_claims.
struct Claims {
  bool reciprocal = false;        // f_r(l, v) = f_r(v, l)
  bool conserves_energy = false;  // a light's reflected share is at most 1
};
// Positivity is claimed by all. Standard, HDRP Lit (without compensation) and normalised
// Cook-Torrance conserve energy where they have no diffuse part: beside one, the highlight's rise
// at grazing angles is added to light that the diffuse part already gave back.
Claims ClaimsOf(const LitMaterial& material);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_MATERIAL_MATERIAL_H_
