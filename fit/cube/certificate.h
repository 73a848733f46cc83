// How far luminance through a table is from proportional, by dense evaluation.
#ifndef EYEBOX_FIT_CUBE_CERTIFICATE_H_
#define EYEBOX_FIT_CUBE_CERTIFICATE_H_

#include "fit/base/activation.h"
#include "fit/cube/design_table.h"

namespace eyebox::fit {

// Of `table.entries` as they stand, wherever they come from. Evaluated at `options.samples` values
// of u, evenly in log u, and for the maximum also where the error bends: at the knots and u0.
// `options.white_u` is the table's.
Certificate Certify(const TableDesign& table, const Activation& activation,
                    const DesignOptions& options);

}  // namespace eyebox::fit

#endif  // EYEBOX_FIT_CUBE_CERTIFICATE_H_
