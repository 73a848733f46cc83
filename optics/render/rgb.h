// A colour on its way through a renderer.
#ifndef EYEBOX_OPTICS_RENDER_RGB_H_
#define EYEBOX_OPTICS_RENDER_RGB_H_

#include <array>

namespace eyebox::optics {

// Red, green, blue. Which light they measure is said where one is named: m (material colour), u
// (scene-linear), t (tonemapped), v (framebuffer, in [0, 1]).
using Rgb = std::array<double, 3>;

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_RENDER_RGB_H_
