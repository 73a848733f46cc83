// What names a rig on the command line.
#ifndef EYEBOX_SERVICE_CLI_RIG_SOURCE_H_
#define EYEBOX_SERVICE_CLI_RIG_SOURCE_H_

#include <string>

#include "absl/status/statusor.h"
#include "capture/camera/rig.h"

namespace eyebox::service::cli {

// A rig file (.textproto), or a camera's URI by itself: the rig's name is then what follows the
// colon. Errors: NotFound; InvalidArgument (says what can be given).
absl::StatusOr<capture::RigConfig> RigOf(const std::string& source);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_RIG_SOURCE_H_
