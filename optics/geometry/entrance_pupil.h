// Where the camera's entrance pupil stands, and what follows from it.
#ifndef EYEBOX_OPTICS_GEOMETRY_ENTRANCE_PUPIL_H_
#define EYEBOX_OPTICS_GEOMETRY_ENTRANCE_PUPIL_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "optics/geometry/camera_model.h"
#include "optics/geometry/field_angle.h"

namespace eyebox::optics {

// Offsets are from the eye point, in a frame of the headset: right, up, and forward out of the eye.
// Turns lead from the headset's straight ahead to the camera's axis, in this order: yaw (right),
// pitch (up), roll (clockwise as the camera sees it).
struct EntrancePupil {
  double diameter_mm = 0;  // 0: unknown
  double right_mm = 0;
  double up_mm = 0;
  double forward_mm = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;

  // Errors: InvalidArgument (not finite, a diameter below 0, a turn of 90 deg or more).
  absl::Status Validate() const;
  // Turns a direction of the camera into one of the headset.
  Rotation RotationHeadsetCamera() const;
  // Angle by which a point at `distance_m` appears shifted, seen from the pupil instead of the eye
  // point: what an offset does to field angles of an image that is not at infinity.
  double ParallaxDeg(double distance_m) const;
};

// What is known of lens and headset, to hold the pupil against; 0: unknown.
struct PupilSurroundings {
  double focal_length_mm = 0;   // of the camera's lens
  double f_number = 0;          // of the camera's lens
  double exit_pupil_mm = 0;     // diameter of the headset's eye box
  double eye_pupil_mm = 0;      // that the measurement is to stand for
  double image_distance_m = 0;  // of the headset's virtual image
};

// What the experimenter should know: the lens's pupil (focal length / f-number) is not what was
// stated; the pupil is larger than the eye's or reaches out of the eye box, so that light is lost;
// it stands before or behind the eye point, so that the field's edge is seen otherwise; the offset
// shifts field angles by more than a tenth of a degree.
std::vector<std::string> PupilWarnings(const EntrancePupil& pupil,
                                       const PupilSurroundings& surroundings);

// A camera in its place: field angles are those of the headset.
struct ViewGeometry {
  CameraModel camera;
  EntrancePupil pupil;

  // As in CameraModel, turned by the pupil's turns; offsets do not enter (an image at infinity).
  std::optional<FieldAngle> FieldAngleOf(const PixelPoint& pixel) const;
  std::optional<PixelPoint> PixelOf(const FieldAngle& angle) const;
};

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_GEOMETRY_ENTRANCE_PUPIL_H_
