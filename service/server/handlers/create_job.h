// What every call that creates a job does once its request is valid.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_CREATE_JOB_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_CREATE_JOB_H_

#include "absl/status/statusor.h"
#include "eyebox/v1/job_service.pb.h"
#include "service/server/handlers/context.h"

namespace eyebox::service {

// Waits for the disk. Errors: those of CheckSources() and of Jobs::Create().
absl::StatusOr<v1::Job> CreateCheckedJob(const HandlerContext& context,
                                         const v1::CreateJobRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_CREATE_JOB_H_
