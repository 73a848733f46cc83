// Lights in physical units, and what of each arrives at a place.
#ifndef EYEBOX_OPTICS_RENDER_SCENE_LIGHT_H_
#define EYEBOX_OPTICS_RENDER_SCENE_LIGHT_H_

#include <variant>

#include "optics/render/material/vec3.h"
#include "optics/render/rgb.h"

namespace eyebox::optics {

// Colours are scene-linear weights of the intensity.

// From far away, the same everywhere.
struct DirectionalLight {
  Rgb colour = {1, 1, 1};
  double illuminance_lux = 1;  // on a surface that faces the light
  Vec3 towards = {0, 0, -1};   // unit, the direction that the light comes from
};

// The same in all directions; by the inverse square of the distance, which counts as at least 1 cm
// (HDRP's PUNCTUAL_LIGHT_THRESHOLD). With a range > 0, times (1 - (distance / range)^4)^2, 0 beyond
// it (HDRP and URP).
struct PointLight {
  Rgb colour = {1, 1, 1};
  double intensity_cd = 1;
  Vec3 position_m;
  double range_m = 0;
};

// A point light within a cone: whole within the inner half angle, then falling to 0 at the outer
// one with the square of a line in the cosine (HDRP and URP).
struct SpotLight {
  PointLight source;
  Vec3 axis = {0, 0, 1};      // unit, the direction that the light travels in
  double outer_deg = 30;      // whole angle of the cone, Unity's Outer Angle; in (0, 180)
  double inner_fraction = 0;  // inner over outer angle, in [0, 1]
};

// The same radiance from everywhere: Unity's gradient sky with one colour.
struct AmbientLight {
  Rgb colour = {1, 1, 1};
  double luminance_cd_m2 = 1;
};

using Light = std::variant<DirectionalLight, PointLight, SpotLight, AmbientLight>;

// A spot light with 1 - cos of its half angles, for many places.
struct SpotCone {
  PointLight source;
  Vec3 axis;
  double outer_cap = 0;
  double inner_cap = 0;
};
SpotCone ConeOf(const SpotLight& light);

// What arrives from a light other than an ambient one.
struct Arrival {
  Vec3 towards;         // unit, towards the light
  Rgb illuminance_lux;  // on a surface that faces it; black where nothing arrives
};
Arrival ArrivalAt(const DirectionalLight& light, const Vec3& position_m);
Arrival ArrivalAt(const PointLight& light, const Vec3& position_m);
Arrival ArrivalAt(const SpotCone& light, const Vec3& position_m);
Arrival ArrivalAt(const SpotLight& light, const Vec3& position_m);

// Direction towards a directional light with Unity's rotation X, Y, in degrees: (-cos X sin Y, sin
// X, -cos X cos Y), left-handed (HDRP model, eq 25). A rotation about Z changes nothing.
Vec3 TowardsLight(double rotation_x_deg, double rotation_y_deg);

// Luminous flux to intensity, as HDRP converts what is typed in lumen: over the whole sphere; over
// the cone of a spot light with its reflector on; over pi with it off.
double PointCandela(double flux_lm);
double SpotCandela(double flux_lm, double outer_deg);
double SpotCandelaWithoutReflector(double flux_lm);
// Illuminance at a distance to intensity.
double CandelaFromLux(double illuminance_lux, double distance_m);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_SCENE_LIGHT_H_
