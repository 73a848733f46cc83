// The work of every job but a capture: the pipeline or a single verb, on what lies below the
// served folder or on a rig.
#ifndef EYEBOX_SERVICE_SERVER_RUN_WORK_H_
#define EYEBOX_SERVICE_SERVER_RUN_WORK_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "service/server/jobs/jobs.h"

namespace eyebox::service {

// Writes the same bytes as the command line. What is read is opened anew for every job, beneath
// `data` and through no link, and stays the same file or folder while it is read.
// Errors: NotFound, InvalidArgument, PermissionDenied for `data`.
absl::StatusOr<Work> MakeRunWork(const std::filesystem::path& data);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_RUN_WORK_H_
