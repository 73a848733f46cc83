// What Aravis' fake camera sees when it runs within this process.
#ifndef EYEBOX_CAPTURE_CAMERA_ARAVIS_FAKE_SCENE_H_
#define EYEBOX_CAPTURE_CAMERA_ARAVIS_FAKE_SCENE_H_

#include "capture/camera/aravis/device.h"

namespace eyebox::capture::aravis {

// A diagonal ramp of 1024 pixels that moves by a pixel with each frame. Counts are proportional to
// the exposure, a quarter of full scale at 10 ms in the brightest pixel and half of that in the
// darkest; they saturate. 8- and 16-bit formats; others stay as the buffer was.
constexpr int kFakeRampPixels = 1024;
double FakeRampCount(int position, double exposure_s, double full_scale_dn);

// Makes the in-process fake camera see it, `rate_hz` times a second at most.
// `device` must be one with is_fake().
void ShowFakeScene(Device& device, double rate_hz);

}  // namespace eyebox::capture::aravis

#endif  // EYEBOX_CAPTURE_CAMERA_ARAVIS_FAKE_SCENE_H_
