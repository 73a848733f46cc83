// The server as a whole: jobs, service, health and reflection behind one unix socket.
#ifndef EYEBOX_SERVICE_SERVER_SERVER_H_
#define EYEBOX_SERVICE_SERVER_SERVER_H_

#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "service/server/jobs/jobs.h"

namespace eyebox::service {

struct ServerOptions {
  std::string listen = "unix:eyebox.sock";
  std::filesystem::path data = ".";               // recordings are named by their path below it
  std::filesystem::path state = ".eyebox-state";  // created if missing; one server at a time
  JobsOptions jobs;
};

class Server {
 public:
  // Listens when it returns. `clock` must outlive the server.
  // Errors: Unimplemented (TCP), InvalidArgument, NotFound, FailedPrecondition (socket or state
  // in use), Unavailable (cannot listen), the errno of the disk.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options, Work work,
                                                       const Clock* clock);
  virtual ~Server() = default;  // stops it

  // Says NOT_SERVING, interrupts the job under way before its next step (it runs again after the
  // next start), tells watchers, lets calls end for a few seconds, then cancels them.
  virtual void Stop() = 0;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_SERVER_H_
