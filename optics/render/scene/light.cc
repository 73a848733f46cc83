#include "optics/render/scene/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "optics/render/material/rgb_sum.h"

namespace eyebox::optics {
namespace {

using std::numbers::pi;

constexpr double kClosestMetres = 0.01;

double Radians(double degrees) { return degrees * (pi / 180); }

// cos and sin of an angle in degrees, exact at multiples of 90.
double CosDeg(double degrees) {
  const double turned = std::abs(std::remainder(degrees, 360.0));
  if (turned == 90) return 0;
  return turned > 90 ? -std::cos(Radians(180 - turned)) : std::cos(Radians(turned));
}
double SinDeg(double degrees) { return CosDeg(90 - std::remainder(degrees, 360.0)); }

// 1 - cos of half the angle, without cancellation.
double HalfAngleCap(double outer_deg) {
  const double sine = std::sin(Radians(outer_deg / 4));
  return 2 * sine * sine;
}

double WithinRange(double distance_m, double range_m) {
  if (range_m <= 0) return 1;
  const double ratio = distance_m / range_m;
  const double left = std::max(0.0, 1 - ratio * ratio * ratio * ratio);
  return left * left;
}

}  // namespace

Arrival ArrivalAt(const DirectionalLight& light, const Vec3&) {
  return {light.towards, light.illuminance_lux * light.colour};
}

Arrival ArrivalAt(const PointLight& light, const Vec3& position_m) {
  const Vec3 to = light.position_m - position_m;
  const double distance_m = Length(to);
  // A light in the very place has no direction.
  if (distance_m == 0) return {{0, 1, 0}, {}};
  const double reach_m = std::max(distance_m, kClosestMetres);
  const double fall = WithinRange(distance_m, light.range_m) / (reach_m * reach_m);
  return {(1 / distance_m) * to, (light.intensity_cd * fall) * light.colour};
}

SpotCone ConeOf(const SpotLight& light) {
  return {light.source, light.axis, HalfAngleCap(light.outer_deg),
          HalfAngleCap(light.outer_deg * light.inner_fraction)};
}

Arrival ArrivalAt(const SpotCone& light, const Vec3& position_m) {
  Arrival arrival = ArrivalAt(light.source, position_m);
  const double off_axis = 1 + Dot(arrival.towards, light.axis);  // 1 - cos of the angle off axis
  if (off_axis >= light.outer_cap) return {arrival.towards, {}};
  if (off_axis <= light.inner_cap) return arrival;
  const double edge = (light.outer_cap - off_axis) / (light.outer_cap - light.inner_cap);
  arrival.illuminance_lux = (edge * edge) * arrival.illuminance_lux;
  return arrival;
}

Arrival ArrivalAt(const SpotLight& light, const Vec3& position_m) {
  return ArrivalAt(ConeOf(light), position_m);
}

Vec3 TowardsLight(double rotation_x_deg, double rotation_y_deg) {
  const double level = CosDeg(rotation_x_deg);
  return {-level * SinDeg(rotation_y_deg), SinDeg(rotation_x_deg), -level * CosDeg(rotation_y_deg)};
}

double PointCandela(double flux_lm) { return flux_lm / (4 * pi); }

double SpotCandela(double flux_lm, double outer_deg) {
  return flux_lm / (2 * pi * HalfAngleCap(outer_deg));
}

double SpotCandelaWithoutReflector(double flux_lm) { return flux_lm / pi; }

double CandelaFromLux(double illuminance_lux, double distance_m) {
  return illuminance_lux * distance_m * distance_m;
}

}  // namespace eyebox::optics
