// Where a target stands before the camera.
#ifndef EYEBOX_OPTICS_GEOMETRY_POSE_H_
#define EYEBOX_OPTICS_GEOMETRY_POSE_H_

#include <array>

#include "optics/geometry/field_angle.h"
#include "optics/geometry/view_points.h"

namespace eyebox::optics {

// From the target's plane (x right, y down, z away from whoever looks at its face, mm) to the
// camera's (right, up, forward), mm. Orthogonal with a determinant of -1: one runs down, one up.
struct Pose {
  Rotation rotation_camera_target = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  Direction translation_mm = {0, 0, 1};

  Direction PointOf(const TargetPoint& point) const;
  // Between the target's normal and the axis.
  double TiltDeg() const;
};

// `pose` turned about the target's origin by a rotation vector of the camera's axes, then moved.
Pose Moved(const Pose& pose, const std::array<double, 3>& turn_rad,
           const std::array<double, 3>& step_mm);

// The pose in which a perspective camera with focal length 1 sees the target's points at `image`
// (x right, y down; the same order): cv::solvePnP of a plane. False where there is none.
bool PoseOf(const std::vector<TargetPoint>& points, const std::vector<std::array<double, 2>>& image,
            Pose& pose);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_POSE_H_
