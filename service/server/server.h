// The server as a whole: jobs, service, health and reflection behind one address.
#ifndef EYEBOX_SERVICE_SERVER_SERVER_H_
#define EYEBOX_SERVICE_SERVER_SERVER_H_

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "service/server/access_options.h"
#include "service/server/jobs/jobs.h"
#include "service/server/observe/health_watch.h"
#include "service/server/observe/log.h"

namespace eyebox::service {

struct ServerOptions {
  std::string listen = "unix:eyebox.sock";
  std::filesystem::path data = ".";               // recordings are named by their path below it
  std::filesystem::path state = ".eyebox-state";  // created if missing; one server at a time
  JobsOptions jobs = {};
  AccessOptions access = {};  // TCP is served with all of its TLS files only
  std::string metrics = "";   // 127.0.0.1:PORT for Prometheus; empty: nowhere
  HealthOptions health = {};
  // A client that has taken nothing of a stream for so long, or twice as long at most, loses it.
  std::chrono::milliseconds stalled_after{60'000};
  std::shared_ptr<ServerLog> log = nullptr;  // none: nothing is logged
};

class Server {
 public:
  // Listens when it returns. `clock` must outlive the server.
  // Errors: InvalidArgument, NotFound, FailedPrecondition (socket or state in use, TCP without
  // mutual TLS, a secret that others may read), Unavailable (cannot listen), the errno of the disk.
  static absl::StatusOr<std::unique_ptr<Server>> Start(const ServerOptions& options, Work work,
                                                       const Clock* clock);
  virtual ~Server() = default;  // stops it

  // Where it listens, as a client writes it: "unix:PATH", or "HOST:PORT" with the port in use.
  virtual std::string address() const = 0;
  // Where metrics are served; 0: nowhere.
  virtual int metrics_port() const = 0;

  // Says NOT_SERVING, interrupts the job under way before its next step (it runs again after the
  // next start), tells watchers, lets calls end for a few seconds, then cancels them.
  virtual void Stop() = 0;
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_SERVER_H_
