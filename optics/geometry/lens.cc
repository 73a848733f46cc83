#include "optics/geometry/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace eyebox::optics {
namespace {

constexpr int kNewtonSteps = 60;
// Of image coordinates in units of the focal length: about 1e-11 px.
constexpr double kSolved = 1e-14;

// Image coordinates in units of the focal length, y down, and their derivatives by the ideal ones.
struct Distorted {
  double x = 0;
  double y = 0;
  double dx_dx = 0;
  double dx_dy = 0;  // = dy_dx: the model is the gradient of a potential
  double dy_dy = 0;
  double Determinant() const { return dx_dx * dy_dy - dx_dy * dx_dy; }
};

// Brown-Conrady (OpenCV calib3d, distortion coefficients k1 k2 p1 p2 k3).
Distorted Distort(const std::array<double, 5>& terms, double x, double y) {
  const auto [k1, k2, p1, p2, k3] = terms;
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + 3 * k3 * r2));  // d radial / d r2, doubled
  return {.x = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          .y = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
          .dx_dx = radial + slope * x * x + 2 * p1 * y + 6 * p2 * x,
          .dx_dy = slope * x * y + 2 * p1 * x + 2 * p2 * y,
          .dy_dy = radial + slope * y * y + 6 * p1 * y + 2 * p2 * x};
}

// Whether the distortion has not folded back anywhere between the axis and (x, y): the least slope
// of the radial part along the way is above 0, and so is the area that is left here.
bool IsUnfolded(const std::array<double, 5>& terms, double x, double y) {
  constexpr int kSamples = 16;
  for (int i = 1; i <= kSamples; ++i) {
    const double share = static_cast<double>(i) / kSamples;
    const Distorted here = Distort(terms, share * x, share * y);
    if (!(here.Determinant() > 0) || !(here.dx_dx + here.dy_dy > 0)) return false;
  }
  return true;
}

std::optional<Projection> ProjectPinhole(const CameraModel& model, const Direction& point) {
  const auto [right, up, forward] = point;
  if (!(forward > 0)) return std::nullopt;
  const double x = right / forward;
  const double y = -up / forward;
  if (!IsUnfolded(model.distortion, x, y)) return std::nullopt;
  const Distorted image = Distort(model.distortion, x, y);
  const double fx = model.focal_length_x_px;
  const double fy = model.focal_length_y_px;
  const double r2 = x * x + y * y;
  Projection result;
  result.pixel = {model.principal_x_px + fx * image.x, model.principal_y_px + fy * image.y};
  result.by_point = {fx * image.dx_dx / forward,
                     -fx * image.dx_dy / forward,
                     -fx * (image.dx_dx * x + image.dx_dy * y) / forward,
                     fy * image.dx_dy / forward,
                     -fy * image.dy_dy / forward,
                     -fy * (image.dx_dy * x + image.dy_dy * y) / forward};
  result.by_parameter = {image.x,
                         0,
                         1,
                         0,
                         fx * x * r2,
                         fx * x * r2 * r2,
                         fx * 2 * x * y,
                         fx * (r2 + 2 * x * x),
                         fx * x * r2 * r2 * r2,
                         0,
                         image.y,
                         0,
                         1,
                         fy * y * r2,
                         fy * y * r2 * r2,
                         fy * (r2 + 2 * y * y),
                         fy * 2 * x * y,
                         fy * y * r2 * r2 * r2};
  return result;
}

struct Radial {
  double value = 0;  // distance from the principal point in focal lengths
  double slope = 0;  // its derivative by the angle off the axis
};

Radial EquidistantRadius(const std::array<double, 5>& k, double angle) {
  const double a2 = angle * angle;
  return {angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3])))),
          1 + a2 * (3 * k[0] + a2 * (5 * k[1] + a2 * (7 * k[2] + a2 * 9 * k[3])))};
}

// The largest sampled angle up to which the radius rises.
double EndOfRise(const std::array<double, 5>& k) {
  constexpr int kSamples = 64;
  double end = 0;
  for (int i = 1; i <= kSamples; ++i) {
    const double angle = std::numbers::pi * i / kSamples;
    if (!(EquidistantRadius(k, angle).slope > 0)) break;
    end = angle;
  }
  return end;
}

std::optional<Projection> ProjectEquidistant(const CameraModel& model, const Direction& point) {
  const double right = point[0];
  const double down = -point[1];
  const double forward = point[2];
  const double across = std::hypot(right, down);
  const double length2 = across * across + forward * forward;
  if (!(length2 > 0) || (across == 0 && forward < 0)) return std::nullopt;
  const double angle = std::atan2(across, forward);
  if (angle > EndOfRise(model.distortion)) return std::nullopt;
  const Radial radial = EquidistantRadius(model.distortion, angle);
  // On the axis itself every direction across is as good as another; the limits below are exact.
  const double cos_a = across > 0 ? right / across : 1;
  const double sin_a = across > 0 ? down / across : 0;
  const double radius_over_across = across > 0 ? radial.value / across : 1 / forward;
  const double along = radial.slope * forward / length2;  // d radius / d across
  const double away = -radial.slope * across / length2;   // d radius / d forward
  const double xx = along * cos_a * cos_a + radius_over_across * sin_a * sin_a;
  const double xy = (along - radius_over_across) * cos_a * sin_a;
  const double yy = along * sin_a * sin_a + radius_over_across * cos_a * cos_a;
  const double fx = model.focal_length_x_px;
  const double fy = model.focal_length_y_px;
  const double x = radial.value * cos_a;
  const double y = radial.value * sin_a;
  Projection result;
  result.pixel = {model.principal_x_px + fx * x, model.principal_y_px + fy * y};
  result.by_point = {fx * xx, -fx * xy, fx * away * cos_a, fy * xy, -fy * yy, fy * away * sin_a};
  result.by_parameter[0] = x;
  result.by_parameter[2] = 1;
  result.by_parameter[kLensParameters + 1] = y;
  result.by_parameter[kLensParameters + 3] = 1;
  double power = angle;
  for (int i = 0; i < 4; ++i) {
    power *= angle * angle;
    result.by_parameter[4 + i] = fx * cos_a * power;
    result.by_parameter[kLensParameters + 4 + i] = fy * sin_a * power;
  }
  return result;
}

std::optional<Direction> BackProjectPinhole(const CameraModel& model, double x_image,
                                            double y_image) {
  double x = x_image;
  double y = y_image;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Distorted at = Distort(model.distortion, x, y);
    const double dx = x_image - at.x;
    const double dy = y_image - at.y;
    const double determinant = at.Determinant();
    if (!(determinant > 0)) return std::nullopt;
    const double step_x = (dx * at.dy_dy - dy * at.dx_dy) / determinant;
    const double step_y = (dy * at.dx_dx - dx * at.dx_dy) / determinant;
    x += step_x;
    y += step_y;
    if (std::hypot(step_x, step_y) > kSolved * (1 + std::hypot(x, y))) continue;
    if (!IsUnfolded(model.distortion, x, y)) return std::nullopt;
    const double length = std::hypot(x, y, 1);
    return Direction{x / length, -y / length, 1 / length};
  }
  return std::nullopt;
}

// Newton within a bracket in which the radius rises.
std::optional<double> AngleOfRadius(const std::array<double, 5>& k, double radius) {
  double low = 0;
  double high = EndOfRise(k);
  if (!(EquidistantRadius(k, high).value >= radius)) return std::nullopt;
  double angle = std::min(radius, high);
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Radial at = EquidistantRadius(k, angle);
    const double excess = at.value - radius;
    (excess > 0 ? high : low) = angle;
    double next = at.slope > 0 ? angle - excess / at.slope : (low + high) / 2;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const double moved = std::abs(next - angle);
    angle = next;
    if (moved <= kSolved * (1 + angle)) return angle;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Projection> Project(const CameraModel& model, const Direction& point) {
  return model.lens == LensModel::kPinhole ? ProjectPinhole(model, point)
                                           : ProjectEquidistant(model, point);
}

std::optional<Direction> BackProject(const CameraModel& model, const PixelPoint& pixel) {
  const double x = (pixel.x_px - model.principal_x_px) / model.focal_length_x_px;
  const double y = (pixel.y_px - model.principal_y_px) / model.focal_length_y_px;
  if (!std::isfinite(x) || !std::isfinite(y)) return std::nullopt;
  if (model.lens == LensModel::kPinhole) return BackProjectPinhole(model, x, y);
  const double radius = std::hypot(x, y);
  const auto angle = AngleOfRadius(model.distortion, radius);
  if (!angle) return std::nullopt;
  const double across = radius > 0 ? std::sin(*angle) / radius : 0;
  return Direction{x * across, -y * across, std::cos(*angle)};
}

}  // namespace eyebox::optics
