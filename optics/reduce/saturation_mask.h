// Which pixels of a stack cannot be trusted because the sensor clipped there or next to it.
#ifndef EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_
#define EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_

#include <cstdint>

#include "capture/base/image.h"
#include "optics/reduce/frame_stacker.h"
#include "optics/reduce/rows.h"

namespace eyebox::optics {

// kSaturated where any frame reached saturation, there or within `dilation` steps of `step_px`
// pixels in x and y (blooming spills into neighbours); 0 elsewhere. [height, width]. A step of 1
// suits a grey sensor. On a colour mosaic a step of 2 reaches the neighbours of the same colour:
// under narrow-band light one colour saturates long before the pixels between, whose counts would
// all be lost.
Image<uint8_t> SaturationMask(const Stack& stack, int dilation, int step_px);

// Those rows of it.
Image<uint8_t> SaturationMask(const Stack& stack, int dilation, int step_px, Rows rows);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_SATURATION_MASK_H_
