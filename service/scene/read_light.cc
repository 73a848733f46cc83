#include "capture/base/status.h"
#include "service/scene/read_scene.h"
#include "service/scene/scene_field.h"

namespace eyebox::service {
namespace {

using optics::Rgb;

absl::StatusOr<optics::Light> ReadDirectional(const v1::DirectionalLight& proto, const Rgb& colour,
                                              const SceneField& field) {
  optics::DirectionalLight light;
  light.colour = colour;
  EYEBOX_ASSIGN_OR_RETURN(light.illuminance_lux,
                          field.Of("intensity").Number(proto.intensity(), kFromZero));
  if (proto.has_towards()) {
    EYEBOX_ASSIGN_OR_RETURN(light.towards, field.Of("towards").Direction(proto.towards()));
    return light;
  }
  const SceneField rotation = field.Of("rotation");
  EYEBOX_ASSIGN_OR_RETURN(const double x,
                          rotation.Of("x_deg").Number(proto.rotation().x_deg(), kAnyFinite));
  EYEBOX_ASSIGN_OR_RETURN(const double y,
                          rotation.Of("y_deg").Number(proto.rotation().y_deg(), kAnyFinite));
  light.towards = optics::TowardsLight(x, y);
  return light;
}

// All but a flux, which each kind of light shares out by itself.
absl::StatusOr<optics::PointLight> ReadSource(const v1::PointLight& proto, const Rgb& colour,
                                              const SceneField& field) {
  optics::PointLight light;
  light.colour = colour;
  EYEBOX_ASSIGN_OR_RETURN(light.position_m, field.Of("position_m").Place(proto.position_m()));
  EYEBOX_ASSIGN_OR_RETURN(light.range_m, field.Of("range_m").Number(proto.range_m(), kFromZero));
  switch (proto.intensity_case()) {
    case v1::PointLight::kCandela: {
      EYEBOX_ASSIGN_OR_RETURN(light.intensity_cd,
                              field.Of("candela").Number(proto.candela(), kFromZero));
      return light;
    }
    case v1::PointLight::kLuxAtOneMetre: {
      EYEBOX_ASSIGN_OR_RETURN(
          const double lux,
          field.Of("lux_at_one_metre").Number(proto.lux_at_one_metre(), kFromZero));
      light.intensity_cd = optics::CandelaFromLux(lux, 1);
      return light;
    }
    case v1::PointLight::kLumen:
      EYEBOX_RETURN_IF_ERROR(field.Of("lumen").Number(proto.lumen(), kFromZero).status());
      return light;
    case v1::PointLight::INTENSITY_NOT_SET:
      break;
  }
  return field.Refuse("has no intensity", "give candela, lumen or lux_at_one_metre");
}

absl::StatusOr<optics::Light> ReadPoint(const v1::PointLight& proto, const Rgb& colour,
                                        const SceneField& field) {
  EYEBOX_ASSIGN_OR_RETURN(optics::PointLight light, ReadSource(proto, colour, field));
  if (proto.has_lumen()) light.intensity_cd = optics::PointCandela(proto.lumen());
  return light;
}

absl::StatusOr<optics::Light> ReadSpot(const v1::SpotLight& proto, const Rgb& colour,
                                       const SceneField& field) {
  optics::SpotLight light;
  EYEBOX_ASSIGN_OR_RETURN(light.source, ReadSource(proto.source(), colour, field.Of("source")));
  EYEBOX_ASSIGN_OR_RETURN(light.axis, field.Of("axis").Direction(proto.axis()));
  const double outer = proto.outer_angle_deg();
  if (!(outer > 0 && outer < 180)) {
    return field.Of("outer_angle_deg").Refuse("is not an angle", "give more than 0, less than 180");
  }
  light.outer_deg = outer;
  EYEBOX_ASSIGN_OR_RETURN(const double inner,
                          field.Of("inner_angle_deg").Number(proto.inner_angle_deg(), {0, outer}));
  light.inner_fraction = inner / outer;
  if (proto.source().has_lumen()) {
    const double flux = proto.source().lumen();
    light.source.intensity_cd = proto.without_reflector()
                                    ? optics::SpotCandelaWithoutReflector(flux)
                                    : optics::SpotCandela(flux, outer);
  }
  return light;
}

}  // namespace

absl::StatusOr<optics::Light> ReadLight(const v1::SceneLight& light, const std::string& where) {
  const SceneField field = {where};
  Rgb colour = {1, 1, 1};
  if (light.has_color()) {
    EYEBOX_ASSIGN_OR_RETURN(colour, field.Of("color").Color(light.color(), kFromZero));
  }
  switch (light.kind_case()) {
    case v1::SceneLight::kDirectional:
      return ReadDirectional(light.directional(), colour, field.Of("directional"));
    case v1::SceneLight::kPoint:
      return ReadPoint(light.point(), colour, field.Of("point"));
    case v1::SceneLight::kSpot:
      return ReadSpot(light.spot(), colour, field.Of("spot"));
    case v1::SceneLight::kAmbient: {
      optics::AmbientLight ambient{colour, 0};
      EYEBOX_ASSIGN_OR_RETURN(
          ambient.luminance_cd_m2,
          field.Of("ambient intensity").Number(light.ambient().intensity(), kFromZero));
      return ambient;
    }
    case v1::SceneLight::KIND_NOT_SET:
      break;
  }
  return field.Refuse("is of no kind", "give directional, point, spot or ambient");
}

}  // namespace eyebox::service
