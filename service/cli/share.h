// Shares and times as people type them.
#ifndef EYEBOX_SERVICE_CLI_SHARE_H_
#define EYEBOX_SERVICE_CLI_SHARE_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace eyebox::service::cli {

// "2%" or "0.02". Errors: InvalidArgument naming `option`.
absl::StatusOr<double> ShareOf(std::string_view option, std::string_view text);

// "120s", "2min" or "120". Errors: likewise.
absl::StatusOr<double> SecondsOf(std::string_view option, std::string_view text);

}  // namespace eyebox::service::cli

#endif  // EYEBOX_SERVICE_CLI_SHARE_H_
