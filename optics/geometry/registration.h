// Where the display's pixels appear through the headset's optics.
#ifndef EYEBOX_OPTICS_GEOMETRY_REGISTRATION_H_
#define EYEBOX_OPTICS_GEOMETRY_REGISTRATION_H_

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/geometry/field_angle.h"
#include "optics/geometry/pixel_point.h"

namespace eyebox::optics {

// A displayed dot and where the camera saw it.
struct DisplayedDot {
  PixelPoint display;  // columns right, rows down
  FieldAngle seen;
};

// Each field angle is a polynomial of total degree `order` of the normalised display pixel
// (s, t) = ((x, y) - centre) / scale, |s| and |t| at most 1 over the dots. Coefficients of s^i t^j
// by rising i + j, then by falling i.
struct DisplayMap {
  int order = 0;
  PixelPoint centre;
  double scale_px = 1;
  std::vector<double> horizontal_deg;
  std::vector<double> vertical_deg;

  FieldAngle FieldAngleOf(const PixelPoint& display) const;
  // By Newton's method, to 1e-9 px. Nothing where it does not settle within 1.5 times the range of
  // the dots: a polynomial says nothing beyond.
  std::optional<PixelPoint> DisplayPixelOf(const FieldAngle& angle) const;
};

struct RegistrationOrder {
  int order = 0;
  double cross_validation_rms_deg = 0;  // of dots left out one by one
};

struct Registration {
  DisplayMap map;
  double residual_rms_deg = 0;  // per angle, degrees of freedom allowed for
  double largest_residual_deg = 0;
  std::vector<RegistrationOrder> orders;  // what was tried
};

// Least squares. `order` 1 to 8, or nothing: the one with the least cross-validation error.
// Errors: InvalidArgument (order out of range, not finite, fewer dots than 3 / 2 of the
// coefficients that the lowest order needs), FailedPrecondition (dots on few lines).
absl::StatusOr<Registration> RegisterDisplay(std::span<const DisplayedDot> dots,
                                             std::optional<int> order = std::nullopt);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_REGISTRATION_H_
