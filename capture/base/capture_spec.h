// The words of a measurement: stimulus, capture, plan (plain values, no device, no file format).
#ifndef EYEBOX_CAPTURE_BASE_CAPTURE_SPEC_H_
#define EYEBOX_CAPTURE_BASE_CAPTURE_SPEC_H_

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace eyebox {

enum class FrameKind {
  kLight,  // the headset shows a stimulus
  kDark,   // no light reaches the sensor
  kFlat,   // a uniform reference display or integrating sphere instead of the headset
};

// What a capture is for.
enum class CaptureRole {
  kMeasurement,
  kReference,  // one and the same patch again and again: shows drift, and a headset that slept
};

enum class StimulusPattern {
  kFullField,
  kDisk,       // bright disk on drive 0, centred on the optical axis
  kBlackDisk,  // disk of drive 0 on a bright field
  // Squares, bright and of drive 0 by turns, over the whole field; four meet on the optical axis,
  // and the one above it to the left is bright.
  kCheckerboard,
};

// Drive values in [0, 1] of the red, green and blue channel, as written to the framebuffer.
using DriveRgb = std::array<double, 3>;

struct Stimulus {
  StimulusPattern pattern = StimulusPattern::kFullField;
  double diameter_deg = 0;        // of the disk, or side of a square; 0 for a full field
  std::optional<DriveRgb> drive;  // empty where unknown (frames measured elsewhere)
  friend bool operator==(const Stimulus&, const Stimulus&) = default;
};

// Frames taken of one stimulus with one setting.
struct CaptureSpec {
  FrameKind kind = FrameKind::kLight;
  std::string series;  // names captures that belong together; "" is the main series
  int level_id = -1;   // index of the drive value in the plan; -1 for darks, flats, unknown
  Stimulus stimulus;
  double exposure_s = 0;
  double gain_db = 0;
  int repeats = 1;
  // Known luminance of what the camera looks at, and its relative standard uncertainty.
  std::optional<double> luminance_cd_m2;
  std::optional<double> luminance_relative_sigma;
  CaptureRole role = CaptureRole::kMeasurement;
  friend bool operator==(const CaptureSpec&, const CaptureSpec&) = default;
};

// In the order in which captures are taken.
struct CapturePlan {
  std::vector<CaptureSpec> captures;
};

}  // namespace eyebox

#endif  // EYEBOX_CAPTURE_BASE_CAPTURE_SPEC_H_
