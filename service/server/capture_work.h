// The work of a capture job: a plan, or a session, on a rig whose stimuli a client shows.
#ifndef EYEBOX_SERVICE_SERVER_CAPTURE_WORK_H_
#define EYEBOX_SERVICE_SERVER_CAPTURE_WORK_H_

#include <filesystem>

#include "absl/status/statusor.h"
#include "service/server/jobs/jobs.h"

namespace eyebox::service {

// Captures into `data`/.partial-ID and renames that to `data`/ID when it is complete. An attempt
// that was interrupted, and one that is asked to resume, goes on after the last capture that is on
// stable storage. It talks with its clients, so it runs in the server's own process; all other work
// is left to `others`. Errors: those of RootFolder::Open(). Of the work: those of the rig and of
// RunPlan(); AlreadyExists (the recording, or what another job left of it); DeadlineExceeded (no
// word of a client), Cancelled.
absl::StatusOr<Work> WithCaptures(const std::filesystem::path& data, Work others);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_CAPTURE_WORK_H_
