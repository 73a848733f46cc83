#include "optics/geometry/pose.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "Eigen/Core"
#include "Eigen/Geometry"
#include "opencv2/calib3d.hpp"
#include "opencv2/core.hpp"

namespace eyebox::optics {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

}  // namespace

Direction Pose::PointOf(const TargetPoint& point) const {
  Direction place = Rotate(rotation_camera_target, {point.x_mm, point.y_mm, 0});
  for (size_t i = 0; i < 3; ++i) place[i] += translation_mm[i];
  return place;
}

double Pose::TiltDeg() const {
  const Direction normal = Rotate(rotation_camera_target, {0, 0, 1});
  return AngleOffAxisDeg({normal[0], normal[1], std::abs(normal[2])});
}

Pose Moved(const Pose& pose, const std::array<double, 3>& turn_rad,
           const std::array<double, 3>& step_mm) {
  const Eigen::Vector3d turn(turn_rad[0], turn_rad[1], turn_rad[2]);
  const double angle = turn.norm();
  Pose moved = pose;
  if (angle > 0) {
    const Eigen::Matrix3d by = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
    Eigen::Map<RowMajor3> rotation(moved.rotation_camera_target.data());
    rotation = (by * rotation).eval();
  }
  for (size_t i = 0; i < 3; ++i) moved.translation_mm[i] += step_mm[i];
  return moved;
}

bool PoseOf(const std::vector<TargetPoint>& points, const std::vector<std::array<double, 2>>& image,
            Pose& pose) {
  std::vector<cv::Point3d> target;
  std::vector<cv::Point2d> seen;
  for (size_t i = 0; i < points.size(); ++i) {
    target.emplace_back(points[i].x_mm, points[i].y_mm, 0);
    seen.emplace_back(image[i][0], image[i][1]);
  }
  cv::Vec3d turn;
  cv::Vec3d step;
  cv::Matx33d rotation;
  try {
    if (!cv::solvePnP(target, seen, cv::Matx33d::eye(), cv::noArray(), turn, step, false,
                      cv::SOLVEPNP_IPPE)) {
      return false;
    }
    cv::Rodrigues(turn, rotation);
  } catch (const cv::Exception&) {
    return false;  // all on a line, for one
  }
  for (int i = 0; i < 3; ++i) {
    const double sign = i == 1 ? -1 : 1;  // rows run down, directions up
    pose.translation_mm[i] = sign * step[i];
    for (int j = 0; j < 3; ++j) pose.rotation_camera_target[3 * i + j] = sign * rotation(i, j);
  }
  return std::isfinite(pose.translation_mm[2]) && pose.translation_mm[2] > 0;
}

}  // namespace eyebox::optics
