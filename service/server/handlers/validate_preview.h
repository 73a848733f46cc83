// Says what is wrong with a request for a preview before anything is touched.
#ifndef EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_PREVIEW_H_
#define EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_PREVIEW_H_

#include "absl/status/status.h"
#include "eyebox/v1/capture_service.pb.h"

namespace eyebox::service {

// Looks at the request alone. Errors: InvalidArgument with the field.
absl::Status ValidatePreview(const v1::PreviewRequest& request);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_HANDLERS_VALIDATE_PREVIEW_H_
