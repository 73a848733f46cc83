// A radial weight on a pixel grid, every pixel the integral of w over its area.
#ifndef EYEBOX_OPTICS_SCATTER_KERNEL_GRID_H_
#define EYEBOX_OPTICS_SCATTER_KERNEL_GRID_H_

#include "capture/base/image.h"
#include "optics/scatter/scatter_kernel.h"

namespace eyebox::optics {

// Weights of the offsets 0 .. width - 1 and 0 .. height - 1 pixels; w is even in both, so this
// quadrant is all of it. The sum over all four is the energy that falls on the covered rectangle, 1
// where that holds the whole reach. However narrow the core, its energy is in the right pixel.
Image<float> SampleKernel(const RadialWeight& weight, double pitch_deg, ImageSize quadrant);

// Sum over all four quadrants.
double SumOverGrid(const Image<float>& quadrant);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_SCATTER_KERNEL_GRID_H_
