// A calibrated camera as a result message, and back.
#ifndef EYEBOX_SERVICE_RESULTS_GEOMETRY_H_
#define EYEBOX_SERVICE_RESULTS_GEOMETRY_H_

#include <optional>
#include <string_view>

#include "absl/status/statusor.h"
#include "eyebox/v1/geometry.pb.h"
#include "optics/geometry/calibrate_lens.h"
#include "optics/geometry/entrance_pupil.h"
#include "optics/geometry/registration.h"

namespace eyebox::service {

// Without registration.
absl::StatusOr<v1::GeometryResult> DescribeGeometry(
    const optics::LensCalibration& calibration, const std::optional<optics::EntrancePupil>& pupil);

void AddRegistration(const optics::Registration& registration, int points,
                     v1::GeometryResult& result);

// Errors: InvalidArgument naming `where` (another model, parameters missing or impossible).
absl::StatusOr<optics::ViewGeometry> GeometryOf(const v1::GeometryResult& result,
                                                std::string_view where);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_RESULTS_GEOMETRY_H_
