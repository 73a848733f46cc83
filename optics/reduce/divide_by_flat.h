// Divides out vignetting and the pixels' unequal response.
#ifndef EYEBOX_OPTICS_REDUCE_DIVIDE_BY_FLAT_H_
#define EYEBOX_OPTICS_REDUCE_DIVIDE_BY_FLAT_H_

#include "absl/status/statusor.h"
#include "optics/reduce/measured_image.h"

namespace eyebox::optics {

// image / response, unit "1" if both are rates. First-order propagation:
// var = (var_image + (image / response)^2 var_response) / response^2.
// kNoFlat where the response is masked, below `minimum` times its median, or not above 5 of its own
// standard deviations. Errors: InvalidArgument (sizes differ), FailedPrecondition (the flat has no
// valid pixel or no light).
absl::StatusOr<MeasuredImage> DivideByFlat(MeasuredImage image, const MeasuredImage& response,
                                           double minimum);

}  // namespace eyebox::optics

#endif  // EYEBOX_OPTICS_REDUCE_DIVIDE_BY_FLAT_H_
