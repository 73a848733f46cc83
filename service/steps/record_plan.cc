#include "service/steps/record_plan.h"

#include "absl/strings/str_cat.h"
#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/recording/writer.h"

namespace eyebox::service {

absl::StatusOr<capture::RunReport> RecordPlan(capture::Rig& rig, const CapturePlan& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(
      const auto writer,
      capture::RecordingWriter::Create(recording, capture::MakeHeader(rig, plan, *SystemClock()),
                                       SystemClock()));
  capture::RunOptions options;
  options.cancelled = watcher.cancelled;
  options.progress = [&watcher](const capture::RunProgress& progress) {
    if (!watcher.progress) return;
    watcher.progress({static_cast<double>(progress.captures_done) / progress.captures_total,
                      absl::StrCat("recording ", progress.captures_total, " captures")});
  };
  return capture::RunPlan(rig, plan, *writer, options);
}

}  // namespace eyebox::service
