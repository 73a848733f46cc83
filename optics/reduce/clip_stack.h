// A mean without the frames that a cosmic ray, a flash or a blink spoilt.
#ifndef EYEBOX_OPTICS_REDUCE_CLIP_STACK_H_
#define EYEBOX_OPTICS_REDUCE_CLIP_STACK_H_

#include "absl/status/statusor.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/sensor/noise_model.h"

namespace eyebox::optics {

// Sigma-clipped mean: per pixel, frames further than `sigmas` standard deviations of one frame from
// the mean of the frames between the extremes are left out of mean_dn and saturated_count and
// counted in rejected_count. At most the two highest and the two lowest of five frames or more, one
// of each of three or four; fewer frames say nothing about which of them is wrong.
//
// One pass over the frames: FrameStacker kept the extremes, and which of them are outliers is
// decided afterwards. The standard deviation is that of the noise model at the mean, not that of
// the clipped frames, which would be too small; what a normal distribution loses beyond 3 sigmas or
// more biases neither the mean (both sides lose alike) nor the stated variance by more than 2.7 %.
// Errors: InvalidArgument (the stack has no extremes, sigmas below 3).
absl::StatusOr<Stack> ClipStack(Stack stack, const NoiseModel& noise, double sigmas);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_CLIP_STACK_H_
