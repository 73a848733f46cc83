// Says what is wrong with a request for a run before anything is touched.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_

#include "absl/status/status.h"
#include "eyebox/v1/service.pb.h"

namespace eyebox::service {

// Looks at the request alone. Errors: InvalidArgument with the field.
absl::Status ValidateRun(const v1::CreateRunRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_
