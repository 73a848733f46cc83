// What the server and a worker say to each other, over one socket that keeps messages apart.
//
//   server: assignment            worker: progress -> server: go on | stop
//                                 worker: may I go on? -> server: go on | stop
//                                 worker: end (a status)
#ifndef EYEBOX_SERVICE_SERVER_WORKER_WORKER_LINK_H_
#define EYEBOX_SERVICE_SERVER_WORKER_WORKER_LINK_H_

#include <optional>
#include <string>
#include <variant>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "service/server/jobs/jobs.h"
#include "service/watcher.h"

namespace eyebox::service {

struct MayIGoOn {};
using WorkerSays = std::variant<Progress, MayIGoOn, absl::Status>;

std::string EncodeAssignment(const Assignment& assignment);
absl::StatusOr<Assignment> DecodeAssignment(const std::string& message);

std::string EncodeProgress(const Progress& progress);
std::string EncodeMayIGoOn();
std::string EncodeEnd(const absl::Status& status);
// Nothing if `message` is none of these: a worker that foreign data took over may send anything.
std::optional<WorkerSays> DecodeWorker(const std::string& message);

// One message whole. Errors: Unavailable (the other end is gone), ResourceExhausted (too long).
absl::Status Send(int socket, const std::string& message);
absl::StatusOr<std::string> Receive(int socket);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_WORKER_WORKER_LINK_H_
