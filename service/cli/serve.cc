#include <signal.h>

#include <cstdio>
#include <memory>
#include <string>

#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/server/run_work.h"
#include "service/server/server.h"

namespace eyebox::service::cli {
namespace {

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

absl::Status Serve(const ServerOptions& options) {
  const sigset_t signals = BlockStopSignals();
  EYEBOX_ASSIGN_OR_RETURN(eyebox::service::Work work, MakeRunWork(options.data));
  EYEBOX_ASSIGN_OR_RETURN(const std::unique_ptr<Server> server,
                          Server::Start(options, std::move(work), SystemClock()));
  std::printf("eyebox: serving %s on %s\n", options.data.c_str(), options.listen.c_str());
  std::fflush(stdout);
  const std::string signal = AwaitStop(signals);
  std::fprintf(stderr, "eyebox: %s, stopping; jobs that have not ended go on at the next start\n",
               signal.c_str());
  server->Stop();
  return absl::OkStatus();
}

}  // namespace

void AddServe(CLI::App& app, Work& work) {
  AddCommand<ServerOptions>(
      app, work, "serve", "Serve runs over gRPC on a unix socket until SIGTERM or SIGINT.",
      "eyebox serve --listen unix:eyebox.sock --data recordings",
      [](CLI::App& command, ServerOptions& options) {
        command
            .add_option("--listen", options.listen, "unix:PATH of the socket, made with mode 0660")
            ->capture_default_str();
        command
            .add_option("--data", options.data,
                        "Folder that is served: recordings are named by their path below it")
            ->capture_default_str();
        command
            .add_option("--state", options.state,
                        "Folder where jobs and results are kept; one server at a time")
            ->capture_default_str();
      },
      Serve);
}

}  // namespace eyebox::service::cli
