#include "optics/geometry/entrance_pupil.h"

#include <cmath>
#include <numbers>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"

namespace eyebox::optics {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kNotedPupilExcess = 1.05;
constexpr double kNotedForwardMm = 1;
constexpr double kNotedParallaxDeg = 0.1;

}  // namespace

absl::Status EntrancePupil::Validate() const {
  if (!std::isfinite(diameter_mm + right_mm + up_mm + forward_mm + yaw_deg + pitch_deg +
                     roll_deg)) {
    return BadInput("entrance pupil", "a figure is not finite", "give numbers");
  }
  if (diameter_mm < 0) {
    return BadInput("entrance pupil", absl::StrFormat("diameter %g mm", diameter_mm),
                    "give its diameter, or 0 where it is unknown");
  }
  for (const double turn : {yaw_deg, pitch_deg, roll_deg}) {
    if (std::abs(turn) < 90) continue;
    return BadInput("entrance pupil", absl::StrFormat("turned by %g deg", turn),
                    "give turns between -90 and 90 deg");
  }
  return absl::OkStatus();
}

Rotation EntrancePupil::RotationHeadsetCamera() const {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  // Axes are right, up, forward, which is left-handed: a positive angle about `up` turns forward
  // to the right as written here.
  const Eigen::Matrix3d turned = (AngleAxisd(yaw_deg * kRadPerDeg, Vector3d::UnitY()) *
                                  AngleAxisd(-pitch_deg * kRadPerDeg, Vector3d::UnitX()) *
                                  AngleAxisd(-roll_deg * kRadPerDeg, Vector3d::UnitZ()))
                                     .toRotationMatrix();
  Rotation rotation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rotation[3 * i + j] = turned(i, j);
  }
  return rotation;
}

double EntrancePupil::ParallaxDeg(double distance_m) const {
  return std::atan2(std::hypot(right_mm, up_mm), 1000 * distance_m - forward_mm) / kRadPerDeg;
}

std::vector<std::string> PupilWarnings(const EntrancePupil& pupil,
                                       const PupilSurroundings& surroundings) {
  std::vector<std::string> warnings;
  const double diameter_mm = pupil.diameter_mm;
  if (surroundings.focal_length_mm > 0 && surroundings.f_number > 0 && diameter_mm > 0) {
    const double lens_mm = surroundings.focal_length_mm / surroundings.f_number;
    if (lens_mm > kNotedPupilExcess * diameter_mm) {
      warnings.push_back(absl::StrFormat(
          "the lens's entrance pupil is %.3g mm (%.3g mm at f/%.3g), larger than the %.3g mm "
          "stated: "
          "check the stop",
          lens_mm, surroundings.focal_length_mm, surroundings.f_number, diameter_mm));
    }
  }
  if (surroundings.eye_pupil_mm > 0 && diameter_mm > surroundings.eye_pupil_mm) {
    warnings.push_back(absl::StrFormat(
        "the camera's pupil of %.3g mm is larger than the eye's of %.3g mm: it collects light that "
        "the eye would not",
        diameter_mm, surroundings.eye_pupil_mm));
  }
  const double reach_mm = std::hypot(pupil.right_mm, pupil.up_mm) + diameter_mm / 2;
  if (surroundings.exit_pupil_mm > 0 && reach_mm > surroundings.exit_pupil_mm / 2) {
    warnings.push_back(absl::StrFormat(
        "the camera's pupil reaches %.3g mm off the axis, the eye box %.3g mm: light is lost",
        reach_mm, surroundings.exit_pupil_mm / 2));
  }
  if (std::abs(pupil.forward_mm) > kNotedForwardMm) {
    warnings.push_back(
        absl::StrFormat("the pupil stands %.3g mm %s the eye point: the edge of the field is seen "
                        "%s than by the eye",
                        std::abs(pupil.forward_mm), pupil.forward_mm > 0 ? "before" : "behind",
                        pupil.forward_mm > 0 ? "wider" : "narrower"));
  }
  if (surroundings.image_distance_m > 0) {
    const double parallax_deg = pupil.ParallaxDeg(surroundings.image_distance_m);
    if (parallax_deg > kNotedParallaxDeg) {
      warnings.push_back(absl::StrFormat(
          "the pupil's offset shifts field angles by %.2g deg at an image distance of %.3g m",
          parallax_deg, surroundings.image_distance_m));
    }
  }
  return warnings;
}

std::optional<FieldAngle> ViewGeometry::FieldAngleOf(const PixelPoint& pixel) const {
  const auto direction = camera.DirectionOf(pixel);
  if (!direction) return std::nullopt;
  return optics::FieldAngleOf(Rotate(pupil.RotationHeadsetCamera(), *direction));
}

std::optional<PixelPoint> ViewGeometry::PixelOf(const FieldAngle& angle) const {
  return camera.PixelOf(
      Rotate(Transposed(pupil.RotationHeadsetCamera()), optics::DirectionOf(angle)));
}

}  // namespace eyebox::optics
