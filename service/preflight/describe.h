// The checks as a message, and back from the file that keeps it.
#ifndef EYEBOX_SERVICE_PREFLIGHT_DESCRIBE_H_
#define EYEBOX_SERVICE_PREFLIGHT_DESCRIBE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "capture/camera/rig.h"
#include "eyebox/v1/preflight.pb.h"
#include "service/preflight/check.h"

namespace eyebox::service {

// `rig` is open. `real_ns` dates the result.
v1::PreflightResult DescribePreflight(std::span<const Check> checks, const capture::Rig& rig,
                                      std::span<const double> exposures_s, int64_t real_ns);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PREFLIGHT_DESCRIBE_H_
