// Field angles and solid angles.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "optics/geometry/camera_model.h"
#include "optics/geometry/field_angle.h"
#include "optics/geometry/solid_angle.h"
#include "tests/tools/numerics/worst_case.h"

namespace eyebox::numerics {
namespace {

using optics::FieldAngle;

Digits50 RadPerDeg50() { return 4 * atan(Digits50(1)) / 180; }

// Near the axis and near 90 deg.
std::vector<double> AnglesDeg(Density density) {
  std::vector<double> angles = {0};
  for (const double step : LogSteps(1e-9, 60, 8 * density.steps)) {
    angles.insert(angles.end(), {step, -step, 90 - step});
  }
  return angles;
}

Digits50 Quadrant50(double horizontal_deg, double vertical_deg) {
  const Digits50 x = tan(Digits50(horizontal_deg * RadPerDeg50()));
  const Digits50 y = tan(Digits50(vertical_deg * RadPerDeg50()));
  return atan(Digits50(x * y / sqrt(Digits50(1 + x * x + y * y))));
}

void AddAngles(Density density, std::vector<Row>& rows) {
  WorstCase direction("DirectionOf, each component", 1e-15);
  WorstCase angle("FieldAngleOf", 1e-15);
  WorstCase off_axis("AngleOffAxisDeg", 1e-15);
  for (const double h : AnglesDeg(density)) {
    for (const double v : AnglesDeg(density)) {
      const optics::Direction found = optics::DirectionOf(FieldAngle{h, v});
      const Digits50 x = tan(Digits50(h * RadPerDeg50()));
      const Digits50 y = tan(Digits50(v * RadPerDeg50()));
      const Digits50 length = sqrt(Digits50(1 + x * x + y * y));
      direction.Compare(found[0], x / length, {{"h deg", h}, {"v deg", v}});
      direction.Compare(found[1], y / length, {{"h deg", h}, {"v deg", v}});
      direction.Compare(found[2], 1 / length, {{"h deg", h}, {"v deg", v}});
      const Digits50 right(found[0]), up(found[1]), forward(found[2]);
      angle.Compare(optics::FieldAngleOf(found)->horizontal_deg,
                    atan2(right, forward) / RadPerDeg50(), {{"h deg", h}, {"v deg", v}});
      off_axis.Compare(
          optics::AngleOffAxisDeg(found),
          atan2(Digits50(sqrt(Digits50(right * right + up * up))), forward) / RadPerDeg50(),
          {{"h deg", h}, {"v deg", v}});
    }
  }
  rows.push_back(direction.row());
  rows.push_back(angle.row());
  rows.push_back(off_axis.row());
}

void AddRectangles(Density density, std::vector<Row>& rows) {
  WorstCase rectangle("SolidAngleSr", 1e-14, Measure::kOfScale);
  for (const double left : {-80.0, -30.0, -1e-6, 0.0, 20.0, 70.0}) {
    for (const double lower : {-85.0, -10.0, 0.0, 45.0}) {
      for (const double side : LogSteps(1e-6, 10, 6 * density.steps)) {
        const double right = left + side;
        const double upper = lower + side / 2;
        rectangle.Compare(optics::SolidAngleSr({left, lower}, {right, upper}),
                          Quadrant50(right, upper) - Quadrant50(left, upper) -
                              Quadrant50(right, lower) + Quadrant50(left, lower),
                          {{"left deg", left}, {"lower deg", lower}, {"side deg", side}});
      }
    }
  }
  rows.push_back(rectangle.row());
}

void AddPixels(Density density, std::vector<Row>& rows) {
  WorstCase pixel("PixelSolidAnglesSr, pinhole", 1e-9);
  for (const double focal_px : LogSteps(20, 5000, 4 * density.steps)) {
    const optics::CameraModel model =
        optics::IdealPinhole({focal_px, 300.25, 20.5}, ImageSize{12, 9});
    const auto found = optics::PixelSolidAnglesSr(model);
    if (!found.ok()) {
      pixel.Compare(std::nan(""), 1, {{"focal length px", focal_px}});
      continue;
    }
    for (int y = 0; y < model.size.height_px; ++y) {
      for (int x = 0; x < model.size.width_px; ++x) {
        const auto corner = [&](double dx, double dy) {
          const Digits50 a = (x + dx - Digits50(model.principal_x_px)) / focal_px;
          const Digits50 b = (y + dy - Digits50(model.principal_y_px)) / focal_px;
          return Digits50(atan(Digits50(a * b / sqrt(Digits50(1 + a * a + b * b)))));
        };
        pixel.Compare(found->at(x, y),
                      corner(0.5, 0.5) - corner(-0.5, 0.5) - corner(0.5, -0.5) + corner(-0.5, -0.5),
                      {{"focal length px", focal_px},
                       {"x", static_cast<double>(x)},
                       {"y", static_cast<double>(y)}});
      }
    }
  }
  rows.push_back(pixel.row());
}

}  // namespace

void AddGeometryRows(Density density, std::vector<Row>& rows) {
  AddAngles(density, rows);
  AddRectangles(density, rows);
  AddPixels(density, rows);
}

}  // namespace eyebox::numerics
