// How each renderer reads a table: where a rendered value falls between the entries, and what
// becomes of an entry on its way to the display.
#ifndef EYEBOX_FIT_CUBE_SAMPLING_H_
#define EYEBOX_FIT_CUBE_SAMPLING_H_

#include <span>

#include "fit/cube/design_table.h"

namespace eyebox::fit {

// Position of the rendered value `u` on the table's axis, in [0, size - 1], to 1e-15 of its length;
// entry i lies at i. A whole number for kPtb.
double PositionOf(TableTarget target, int size, double u);
// Its inverse.
double UAtPosition(TableTarget target, int size, double position);
// The largest u that the axis reaches: 58.85666 in HDRP, else 1.
double LargestU(TableTarget target);

// Linear between neighbouring entries, to 1e-15 of the largest; `position` in [0, entries.size() -
// 1].
double Interpolate(std::span<const double> entries, double position);

// The entry that reaches the display as `drive`. HDRP encodes what it reads with the inverse sRGB
// transfer; the other targets hold drive values.
double EntryOfDrive(TableTarget target, double drive);
// The drive value that reaches the display, cut to [0, 1].
double DriveOfEntry(TableTarget target, double entry);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_SAMPLING_H_
