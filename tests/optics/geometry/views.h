// Views of a flat grid through a lens of known parameters.
#ifndef EYEBOX_TESTS_OPTICS_GEOMETRY_VIEWS_H_
#define EYEBOX_TESTS_OPTICS_GEOMETRY_VIEWS_H_

#include <cmath>
#include <random>
#include <vector>

#include "absl/strings/str_cat.h"
#include "optics/geometry/camera_model.h"
#include "optics/geometry/pose.h"
#include "optics/geometry/view_points.h"

namespace eyebox::optics {

inline CameraModel NarrowLens() {
  return {.lens = LensModel::kPinhole,
          .size = {640, 480},
          .focal_length_x_px = 820,
          .focal_length_y_px = 815,
          .principal_x_px = 325.3,
          .principal_y_px = 236.8,
          .distortion = {-0.18, 0.09, 0.0008, -0.0006, 0}};
}

// 55 deg lie 0.96 rad or about 290 px from the middle.
inline CameraModel WideLens() {
  return {.lens = LensModel::kEquidistant,
          .size = {640, 600},
          .focal_length_x_px = 302,
          .focal_length_y_px = 300,
          .principal_x_px = 322.1,
          .principal_y_px = 296.4,
          .distortion = {0.031, -0.012, 0.004, -0.0007, 0}};
}

struct GridBoard {
  int columns = 11;
  int rows = 8;
  double pitch_mm = 10;
};

// Nine poses: straight on, tilted four ways, and towards the corners. Points that the sensor does
// not hold are left out.
inline std::vector<ViewPoints> SeenThrough(const CameraModel& lens, const GridBoard& board,
                                           double distance_mm, double sigma_px, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  const double turns[9][3] = {{0, 0, 0},      {0.5, 0, 0},      {-0.5, 0.1, 0},
                              {0, 0.5, 0.2},  {0, -0.5, 0},     {0.35, 0.35, -0.3},
                              {-0.3, 0.4, 0}, {0.3, -0.4, 0.1}, {-0.4, -0.3, 0}};
  const double steps[9][3] = {{0, 0, 0},  {8, -6, 10},    {-10, 6, 0}, {12, 4, -8}, {-12, -4, 5},
                              {14, 9, 0}, {-14, -9, -10}, {-9, 12, 0}, {10, -12, 0}};
  std::vector<ViewPoints> views;
  for (int v = 0; v < 9; ++v) {
    const Pose pose =
        Moved({.translation_mm = {0, 0, distance_mm}}, {turns[v][0], turns[v][1], turns[v][2]},
              {steps[v][0], steps[v][1], steps[v][2]});
    ViewPoints view{absl::StrCat("view ", v), {}};
    for (int row = 0; row < board.rows; ++row) {
      for (int column = 0; column < board.columns; ++column) {
        TargetPoint point{.x_mm = board.pitch_mm * (column - (board.columns - 1) / 2.0),
                          .y_mm = board.pitch_mm * (row - (board.rows - 1) / 2.0),
                          .pixel = {}};
        const auto pixel = lens.PixelOf(pose.PointOf(point));
        if (!pixel || pixel->x_px < 0 || pixel->y_px < 0 || pixel->x_px > lens.size.width_px - 1 ||
            pixel->y_px > lens.size.height_px - 1) {
          continue;
        }
        const double dx = noise(random);
        const double dy = noise(random);
        point.pixel = {pixel->x_px + sigma_px * dx, pixel->y_px + sigma_px * dy};
        view.points.push_back(point);
      }
    }
    views.push_back(view);
  }
  return views;
}

inline std::vector<double> ParametersOf(const CameraModel& model) {
  std::vector<double> parameters = {model.focal_length_x_px, model.focal_length_y_px,
                                    model.principal_x_px, model.principal_y_px};
  parameters.insert(parameters.end(), model.distortion.begin(), model.distortion.end());
  return parameters;
}

}  // namespace eyebox::optics

#endif  // EYEBOX_TESTS_OPTICS_GEOMETRY_VIEWS_H_
