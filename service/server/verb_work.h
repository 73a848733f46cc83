// The work of a job that is a single verb of the command line.
#ifndef EYEBOX_SERVICE_SERVER_VERB_WORK_H_
#define EYEBOX_SERVICE_SERVER_VERB_WORK_H_

#include "absl/status/status.h"
#include "service/server/jobs/jobs.h"
#include "service/server/store/beneath.h"
#include "service/watcher.h"

namespace eyebox::service {

// Everything but run and capture. Leaves result.json, the bytes that `eyebox VERB --json` prints,
// beside the files that `--out` names. Paths in result and errors are those that the client gave.
// Errors: those of the verb.
absl::Status CarryOutVerb(const RootFolder& data, const Assignment& assignment,
                          const Watcher& watcher);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_VERB_WORK_H_
