// Which pixels of a stack cannot be trusted because the sensor clipped there or next to it.
#ifndef EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_
#define EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_

#include <cstdint>

#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"

namespace eyebox::optics {

// kSaturated where any frame reached saturation, there or within `dilation_px` pixels in x and y
// (blooming spills into neighbours); 0 elsewhere. [height, width].
Image<uint8_t> SaturationMask(const Stack& stack, int dilation_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_
