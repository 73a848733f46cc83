#include "service/server/catalogue/catalogue.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include "absl/time/time.h"
#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "service/cli/command.h"
#include "service/cli/terminal.h"
#include "service/server/store/beneath.h"
#include "service/server/store/paging.h"

namespace eyebox::service::cli {
namespace {

struct Options {
  std::filesystem::path store = ".";
  std::filesystem::path state = ".eyebox-state";
  std::string filter;
  std::string order_by = "name";
  bool rebuild = false;
  bool json = false;
};

const char* WordFor(v1::RecordingState state) {
  switch (state) {
    case v1::RECORDING_STATE_COMPLETE:
      return "complete";
    case v1::RECORDING_STATE_PARTIAL:
      return "partial";
    case v1::RECORDING_STATE_DAMAGED:
      return "damaged";
    default:
      return "unknown";
  }
}

std::string StartOf(const v1::RecordingEntry& entry) {
  const int64_t start_ns = entry.header().created_real_ns();
  if (start_ns <= 0) return "-";
  return absl::FormatTime("%Y-%m-%dT%H:%M:%SZ", absl::FromUnixNanos(start_ns), absl::UTCTimeZone());
}

void Print(const v1::ListRecordingsResponse& all) {
  std::printf("%-9s %-20s %8s %8s %10s  %-20s %s\n", "state", "start", "captures", "frames", "MB",
              "rig", "name");
  for (const v1::RecordingEntry& one : all.recordings()) {
    constexpr double kBytesPerMb = 1e6;
    std::printf("%-9s %-20s %8d %8lld %10.1f  %-20s %s\n", WordFor(one.state()),
                StartOf(one).c_str(), one.captures(), static_cast<long long>(one.frames()),
                static_cast<double>(one.bytes()) / kBytesPerMb, one.header().rig().name().c_str(),
                one.name().c_str());
    if (!one.problem().empty()) std::printf("    %s\n", one.problem().c_str());
  }
}

// Every page, as one.
absl::StatusOr<v1::ListRecordingsResponse> ListAll(Catalogue& catalogue, const Options& options) {
  v1::ListRecordingsRequest request;
  request.set_filter(options.filter);
  request.set_order_by(options.order_by);
  request.set_page_size(kMaxPageSize);
  EYEBOX_ASSIGN_OR_RETURN(v1::ListRecordingsResponse all, catalogue.List(request));
  while (!all.next_page_token().empty()) {
    request.set_page_token(all.next_page_token());
    EYEBOX_ASSIGN_OR_RETURN(const v1::ListRecordingsResponse page, catalogue.Look(request));
    all.mutable_recordings()->MergeFrom(page.recordings());
    all.set_next_page_token(page.next_page_token());
  }
  return all;
}

// Closed to others where it is new, as serve makes it.
absl::Status PrepareState(const std::filesystem::path& state) {
  using std::filesystem::perms;
  std::error_code error;
  const bool is_new = std::filesystem::create_directories(state, error);
  if (!error && is_new) {
    std::filesystem::permissions(state, perms::others_all, std::filesystem::perm_options::remove,
                                 error);
  }
  return error ? SystemFailed(state.string(), error.value(), "give another --state")
               : absl::OkStatus();
}

absl::Status Run(const Options& options) {
  EYEBOX_ASSIGN_OR_RETURN(const RootFolder store, RootFolder::Open(options.store));
  EYEBOX_RETURN_IF_ERROR(PrepareState(options.state));
  Catalogue catalogue(options.state, &store, SystemClock(), [](const std::string& what) {
    std::fprintf(stderr, "eyebox: %s\n", what.c_str());
  });
  if (options.rebuild) EYEBOX_RETURN_IF_ERROR(catalogue.Rebuild("as was asked for"));
  EYEBOX_ASSIGN_OR_RETURN(const v1::ListRecordingsResponse all, ListAll(catalogue, options));
  if (options.json) return PrintJson(all);
  Print(all);
  return absl::OkStatus();
}

}  // namespace

void AddCatalogue(CLI::App& app, Work& work) {
  AddCommand<Options>(
      app, work, "catalogue",
      "List the recordings below a folder, those that match a filter, or make the index anew.",
      "eyebox catalogue --store recordings --filter 'state = COMPLETE AND start_time >= "
      "\"2026-11-01\"'\n  eyebox catalogue --store recordings --rebuild",
      [](CLI::App& command, Options& options) {
        command.add_option("--store", options.store, "Folder that holds recordings, at any depth")
            ->capture_default_str();
        command
            .add_option("--state", options.state,
                        "Folder where the index catalogue.sqlite is kept, as that of serve")
            ->capture_default_str();
        command.add_option(
            "--filter", options.filter,
            "FIELD OPERATOR VALUE, joined by AND. Fields: name, rig, camera, state (COMPLETE, "
            "PARTIAL, DAMAGED), origin, start_time, captures, frames, bytes, levels; series and "
            "results with ':' (has)");
        command
            .add_option("--order-by", options.order_by,
                        "name or start_time, ' desc' behind it: backwards")
            ->capture_default_str();
        command.add_flag("--rebuild", options.rebuild,
                         "Make the index anew from the recordings first");
        command.add_flag("--json", options.json, "Print the recordings as JSON on stdout");
      },
      Run);
}

}  // namespace eyebox::service::cli
