#include <signal.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/server/capture_work.h"
#include "service/server/observe/log.h"
#include "service/server/run_work.h"
#include "service/server/server.h"
#include "service/server/worker/worker_process.h"

namespace eyebox::service::cli {
namespace {

constexpr double kBytesPerGb = 1e9;

// Blocked before any thread starts, so that the signals come to AwaitStop alone.
sigset_t BlockStopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

std::string AwaitStop(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  return signal == SIGTERM ? "SIGTERM" : "SIGINT";
}

void AddAccessOptions(CLI::App& command, AccessOptions& access) {
  command.add_option("--tls-cert", access.tls.certificate, "PEM: the server's certificate chain");
  command.add_option("--tls-key", access.tls.key, "PEM: its key, readable by its owner alone");
  command.add_option("--tls-client-ca", access.tls.client_ca,
                     "PEM: only clients with a certificate of these authorities are served");
  command.add_option("--token-file", access.token_file,
                     "File, readable by its owner alone, with a token that every call must carry "
                     "as 'authorization: Bearer TOKEN'");
}

struct ServeOptions {
  ServerOptions server;
  double min_free_gb = 1;
  double stalled_after_s = 60;
};

absl::Status Serve(const ServeOptions& asked) {
  ServerOptions options = asked.server;
  options.stalled_after =
      std::chrono::milliseconds(static_cast<int64_t>(1000 * asked.stalled_after_s));
  options.health.min_free_bytes = static_cast<uint64_t>(asked.min_free_gb * kBytesPerGb);
  options.log = std::make_shared<ServerLog>();
  const sigset_t signals = BlockStopSignals();
  // Of this very program, whatever has become of its file since.
  eyebox::service::Work work =
      MakeProcessWork({"/proc/self/exe", "worker", "--data", options.data.string()}, {});
  EYEBOX_ASSIGN_OR_RETURN(work, WithCaptures(options.data, std::move(work)));
  EYEBOX_ASSIGN_OR_RETURN(const std::unique_ptr<Server> server,
                          Server::Start(options, std::move(work), SystemClock()));
  std::printf("eyebox: serving %s on %s\n", options.data.c_str(), server->address().c_str());
  std::fflush(stdout);
  const std::string signal = AwaitStop(signals);
  std::fprintf(stderr, "eyebox: %s, stopping; jobs that have not ended go on at the next start\n",
               signal.c_str());
  server->Stop();
  return absl::OkStatus();
}

struct WorkerOptions {
  std::filesystem::path data;
};

absl::Status DoAssignment(const WorkerOptions& options) {
  EYEBOX_ASSIGN_OR_RETURN(const eyebox::service::Work work, MakeRunWork(options.data));
  if (ServeAssignment(work) == 0) return absl::OkStatus();
  return absl::InternalError(
      Complaint("worker", "no server told what to do", "leave it to eyebox serve to start it"));
}

}  // namespace

void AddServe(CLI::App& app, Work& work) {
  AddCommand<ServeOptions>(
      app, work, "serve",
      "Serve runs over gRPC until SIGTERM or SIGINT, on a unix socket or on TCP with mutual TLS.",
      "eyebox serve --listen unix:eyebox.sock --data recordings\n"
      "  eyebox serve --listen 0.0.0.0:50051 --tls-cert server.pem --tls-key server.key "
      "--tls-client-ca clients.pem",
      [](CLI::App& command, ServeOptions& options) {
        command
            .add_option("--listen", options.server.listen,
                        "unix:PATH of the socket, made with mode 0660; or HOST:PORT, with the "
                        "three --tls options")
            ->capture_default_str();
        command
            .add_option("--data", options.server.data,
                        "Folder that is served: recordings are named by their path below it")
            ->capture_default_str();
        command
            .add_option("--state", options.server.state,
                        "Folder where jobs and results are kept; one server at a time")
            ->capture_default_str();
        AddAccessOptions(command, options.server.access);
        command.add_option("--metrics", options.server.metrics,
                           "127.0.0.1:PORT where Prometheus may read figures (default: nowhere)");
        command
            .add_option("--stalled-after", options.stalled_after_s,
                        "Seconds after which a client that reads nothing of a stream loses it")
            ->check(CLI::Range(1.0, 86400.0))
            ->capture_default_str();
        command
            .add_option("--min-free-gb", options.min_free_gb,
                        "Health says NOT_SERVING while a disk has less than this left")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
      },
      Serve);
  // What serve starts for each job; nobody is told of it.
  AddCommand<WorkerOptions>(
      app, work, "worker", "Does one job for the server that started it.", "eyebox serve",
      [](CLI::App& command, WorkerOptions& options) {
        command.group("");
        command.add_option("--data", options.data, "Folder that is served")->required();
      },
      DoAssignment);
}

}  // namespace eyebox::service::cli
