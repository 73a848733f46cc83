// A colour fit and a three-dimensional table as result messages, and the fit back.
#ifndef EYEBOX_SERVICE_RESULTS_COLOUR_H_
#define EYEBOX_SERVICE_RESULTS_COLOUR_H_

#include <string_view>

#include "absl/status/statusor.h"
#include "eyebox/v1/color.pb.h"
#include "fit/color/colour_table.h"
#include "fit/color/fit_colour.h"

namespace eyebox::service {

// Everything but `source`.
v1::ColourResult DescribeColour(const fit::ColourChoice& choice);

// Errors: InvalidArgument naming `where` and the parameter that is absent or out of range, or the
// model that there is not.
absl::StatusOr<fit::ColourModel> ColourModelOf(const v1::ColourResult& result,
                                               std::string_view where);

// `bytes` is what the file of that name holds.
v1::ColourCubeResult DescribeColourCube(const fit::ColourTable& table, const fit::GoalOptions& goal,
                                        const v1::ColourResult& colour, std::string_view file,
                                        std::string_view bytes);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_COLOUR_H_
