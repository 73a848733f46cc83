// Says what is wrong with a request for a job before anything is touched.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_JOB_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_JOB_H_

#include "absl/status/status.h"
#include "eyebox/v1/job_service.pb.h"
#include "service/server/store/beneath.h"

namespace eyebox::service {

// Looks at the request alone. Errors: InvalidArgument with the field.
absl::Status ValidateJob(const v1::CreateJobRequest& request);

// Whether what the valid request names is there. Waits for the disk.
// Errors: NotFound, PermissionDenied, AlreadyExists (the recording to be captured), with the field.
absl::Status CheckSources(const RootFolder& data, const v1::CreateJobRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_JOB_H_
