// Says what is wrong with a request for a run before anything is touched.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_

#include <string>

#include "absl/status/status.h"
#include "eyebox/v1/service.pb.h"

namespace eyebox::service {

// Looks at the request alone. Errors: InvalidArgument with the field.
absl::Status ValidateRun(const v1::CreateRunRequest& request);
// The same but for the request_id.
absl::Status ValidateRunWork(const v1::CreateRunRequest& request);
// 0, or 3 to 100.
absl::Status ValidateClip(const std::string& field, double sigmas);
// A simulated rig.
absl::Status ValidateRig(const v1::Rig& rig);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_RUN_H_
