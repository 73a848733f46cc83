// The mean count of a frame: how a run sees whether the light is as it should be.
#ifndef EYEBOX_CAPTURE_RUN_FRAME_MEAN_H_
#define EYEBOX_CAPTURE_RUN_FRAME_MEAN_H_

#include <vector>

#include "capture/base/image.h"

namespace eyebox::capture {

struct FrameMean {
  double mean_dn = 0;
  double sigma_dn = 0;  // standard uncertainty of the mean
  double noise_dn = 0;  // of that, what the noise of pixels alone makes
};

// Over evenly spaced rows, 262144 pixels or a little more, so that it costs the same whatever the
// sensor. The sigma is that of the pixels' scatter about their neighbours of the same colour: an
// upper bound, for it counts fixed pattern as noise. A frame without pixels has mean 0.
FrameMean MeanOf(const FrameView& frame);

// Of frames of one scene. The sigma is the larger of what the pixels and what the frames tell, so
// that a display that flickers as a whole is not taken for a steady one. `frames` is not empty.
FrameMean MeanOf(const std::vector<FrameMean>& frames);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_RUN_FRAME_MEAN_H_
