// Something to look at where the sensor has a hole.
#ifndef EYEBOX_OPTICS_REDUCE_REPAIR_DEFECTS_H_
#define EYEBOX_OPTICS_REDUCE_REPAIR_DEFECTS_H_

#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// Gives each pixel that is invalid for kDefective alone the mean of its valid neighbours of the
// same colour (8, `colour_period_px` apart) and sets kRepaired beside kDefective. It stays invalid:
// its variance is NaN, and nothing that looks at the mask takes it for a measurement. Pixels
// without a valid neighbour stay as they are. To be done last: steps blank what is masked.
MeasuredImage RepairDefects(MeasuredImage image, int colour_period_px);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_REPAIR_DEFECTS_H_
