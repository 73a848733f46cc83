// What a client of a capture job is told.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_STIMULUS_STEP_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_STIMULUS_STEP_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "eyebox/v1/capture_service.pb.h"
#include "service/server/jobs/jobs.h"

namespace eyebox::service {

// The newest thing to show; step 0 where it is not above `after`, and when the job has ended or
// has not begun. Errors: NotFound; FailedPrecondition (the job does not say what to show).
absl::StatusOr<v1::StimulusStep> StepAfter(Jobs& jobs, int64_t number, uint64_t after);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_STIMULUS_STEP_H_
