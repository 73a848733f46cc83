// What a texture importer makes of a table when it compresses it.
#ifndef EYEBOX_FIT_CUBE_BLOCK_COMPRESSION_H_
#define EYEBOX_FIT_CUBE_BLOCK_COMPRESSION_H_

#include "fit/cube/table_file.h"

namespace eyebox::fit {

// `cube` cut to [0, 1], each 4 x 4 block (red x green) of each blue slice as BC1 holds it: two end
// colours of 5, 6 and 5 bits, at the corners of the block's bounding box, and two in between; every
// entry becomes the nearest of the four.
Cube3d CompressBlocks(const Cube3d& cube);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_BLOCK_COMPRESSION_H_
