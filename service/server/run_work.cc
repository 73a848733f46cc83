#include "service/server/run_work.h"

#include <memory>
#include <string>
#include <utility>

#include "absl/strings/str_replace.h"
#include "capture/base/status.h"
#include "service/pipeline.h"
#include "service/server/store/beneath.h"
#include "service/server/store/rigs.h"
#include "service/server/verb_work.h"

namespace eyebox::service {
namespace {

RunOptions OptionsOf(const v1::CreateRunRequest& request) {
  RunOptions options;
  if (request.hdrp_cube_size() != 0) options.hdrp_cube_size = request.hdrp_cube_size();
  if (request.pps_strip_size() != 0) options.pps_strip_size = request.pps_strip_size();
  options.clip_sigmas = request.clip_sigmas();
  return options;
}

// A client knows its recording by name; how the server got hold of it says nothing.
absl::Status NamedAsAsked(const absl::Status& status, const std::string& path,
                          const std::string& name) {
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrReplaceAll(status.message(), {{path, name}}));
}

absl::Status RunOnRecording(const RootFolder& data, const Assignment& assignment,
                            const Watcher& watcher) {
  const std::string& name = assignment.request.run().recording();
  EYEBOX_ASSIGN_OR_RETURN(const OwnedFd recording, data.OpenFolder(name));
  const auto result =
      RunRecording(recording.Path(), assignment.out, OptionsOf(assignment.request.run()), watcher);
  return NamedAsAsked(result.status(), recording.Path().string(), name);
}

absl::Status RunOnRig(const Assignment& assignment, const Watcher& watcher) {
  return RunRig(ConfigOf(assignment.request.run().rig()), assignment.recording, assignment.out,
                OptionsOf(assignment.request.run()), watcher)
      .status();
}

}  // namespace

absl::StatusOr<Work> MakeRunWork(const std::filesystem::path& data) {
  EYEBOX_ASSIGN_OR_RETURN(RootFolder opened, RootFolder::Open(data));
  const auto root = std::make_shared<const RootFolder>(std::move(opened));
  return [root](const Assignment& assignment, const Watcher& watcher) {
    const v1::CreateJobRequest& request = assignment.request;
    if (!request.has_run()) return CarryOutVerb(*root, assignment, watcher);
    return request.run().has_recording() ? RunOnRecording(*root, assignment, watcher)
                                         : RunOnRig(assignment, watcher);
  };
}

}  // namespace eyebox::service
