#include "service/cli/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <memory>

#include "capture/base/status.h"
#include "service/result_json.h"

namespace eyebox::service::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

constexpr int kBarCells = 30;

void DrawBar(const Progress& progress) {
  const int filled = static_cast<int>(progress.fraction * kBarCells);
  std::string bar(kBarCells, '.');
  std::fill_n(bar.begin(), std::clamp(filled, 0, kBarCells), '#');
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %%  %s", bar.c_str(), 100 * progress.fraction,
               progress.step.c_str());
  if (progress.fraction >= 1) std::fprintf(stderr, "\n");
}

}  // namespace

absl::Status PrintJson(const google::protobuf::Message& message) {
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(message));
  std::fputs(json.c_str(), stdout);
  return absl::OkStatus();
}

void PrintParameters(const google::protobuf::RepeatedPtrField<v1::Parameter>& parameters) {
  for (const v1::Parameter& parameter : parameters) {
    std::printf("  %-24s %12.6g", parameter.name().c_str(), parameter.value());
    if (parameter.sigma() > 0) std::printf(" +- %-10.3g", parameter.sigma());
    std::printf(" %s\n", parameter.unit() == "1" ? "" : parameter.unit().c_str());
  }
}

void PrintCertificate(const v1::CubeResult& cube) {
  const v1::Certificate& certificate = cube.certificate();
  std::printf("  %-24s worst luminance error %.3f %% (at u = %.4f), rms %.3f %%, u %.2f to %.2f\n",
              (cube.target() + " " + std::to_string(cube.size())).c_str(),
              100 * certificate.max_relative(), certificate.at_u(),
              100 * certificate.rms_relative(), certificate.u_from(), certificate.u_to());
  for (const v1::StorageCertificate& stored : cube.storage_certificates()) {
    std::printf("  after %-28s worst %.3f %% (%s, at u = %.4f), rms %.3f %%, 8-bit step %.2f %%\n",
                stored.storage().c_str(), 100 * stored.certificate().max_relative(),
                stored.worst_channel().c_str(), stored.certificate().at_u(),
                100 * stored.certificate().rms_relative(), 100 * stored.contrast_step_8bit());
  }
}

void PrintWarnings(const google::protobuf::RepeatedPtrField<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::fprintf(stderr, "eyebox: note: %s\n", warning.c_str());
  }
}

Watcher TerminalWatcher() {
  std::signal(SIGINT, [](int) { interrupted = 1; });
  Watcher watcher;
  watcher.cancelled = [] { return interrupted != 0; };
  if (isatty(STDERR_FILENO) != 0) {
    watcher.progress = DrawBar;
    return watcher;
  }
  auto last_step = std::make_shared<std::string>();
  watcher.progress = [last_step](const Progress& progress) {
    if (progress.step == *last_step) return;
    *last_step = progress.step;
    std::fprintf(stderr, "eyebox: %s\n", progress.step.c_str());
  };
  return watcher;
}

}  // namespace eyebox::service::cli
