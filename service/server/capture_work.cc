#include "service/server/capture_work.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "capture/base/clock.h"
#include "capture/base/file.h"
#include "capture/base/status.h"
#include "capture/recording/convert.h"
#include "capture/recording/reader.h"
#include "eyebox/v1/capture.pb.h"
#include "service/result_json.h"
#include "service/results/parameter.h"
#include "service/server/store/beneath.h"
#include "service/server/store/names.h"
#include "service/server/store/rigs.h"
#include "service/steps/record_plan.h"
#include "service/stimulus_words.h"

namespace eyebox::service {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualClientTimeoutS = 600;
constexpr char kRemedy[] = "check the disk of the served folder";

struct Place {
  fs::path partial;
  fs::path recording;
};

Place PlaceOf(const RootFolder& data, const v1::CaptureWork& work) {
  return {.partial = data.Path() / PartialName(work.recording_id()),
          .recording = data.Path() / work.recording_id()};
}

std::chrono::milliseconds TimeoutOf(const v1::CaptureWork& work) {
  const double seconds =
      work.client_timeout_s() > 0 ? work.client_timeout_s() : kUsualClientTimeoutS;
  return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
}

// Asks the client for every new scene; what the rig presents by itself is presented after that.
class DeskPresenter final : public capture::StimulusPresenter {
 public:
  DeskPresenter(const Assignment& assignment, std::unique_ptr<capture::StimulusPresenter> inner,
                std::function<bool()> cancelled)
      : assignment_(assignment), inner_(std::move(inner)), cancelled_(std::move(cancelled)) {}

  // Before this nobody is asked: a simulated rig catches up with what was captured before.
  void Begin() { begun_ = true; }

  absl::Status Present(const CaptureSpec& spec) override {
    if (begun_ && (!shown_ || !IsSameScene(*shown_, spec))) {
      EYEBOX_RETURN_IF_ERROR(
          assignment_.desk->AwaitShown(capture::ToProto(spec), WhatToShow(spec), cancelled_,
                                       TimeoutOf(assignment_.request.capture())));
      shown_ = spec;
    }
    return inner_ ? inner_->Present(spec) : absl::OkStatus();
  }

 private:
  const Assignment& assignment_;
  const std::unique_ptr<capture::StimulusPresenter> inner_;
  const std::function<bool()> cancelled_;
  bool begun_ = false;
  std::optional<CaptureSpec> shown_;
};

absl::StatusOr<CapturePlan> PlanOf(const v1::CapturePlan& proto) {
  CapturePlan plan;
  for (int i = 0; i < proto.captures_size(); ++i) {
    EYEBOX_ASSIGN_OR_RETURN(
        plan.captures.emplace_back(),
        capture::FromProto(proto.captures(i), absl::StrCat("plan, capture ", i + 1)));
  }
  return plan;
}

absl::Status CarryOutPlan(capture::Rig& rig, const CapturePlan& plan, const fs::path& partial,
                          bool resume, const Assignment& assignment, const Watcher& watcher) {
  auto presenter =
      std::make_unique<DeskPresenter>(assignment, std::move(rig.presenter), watcher.cancelled);
  DeskPresenter& desk = *presenter;
  rig.presenter = std::move(presenter);
  Watcher begins = watcher;
  begins.progress = [&desk, &watcher](const Progress& progress) {
    desk.Begin();
    if (watcher.progress) watcher.progress(progress);
  };
  assignment.desk->Open(StimulusDesk::Way::kPlan);
  return resume ? ResumePlan(rig, plan, partial, begins).status()
                : RecordPlan(rig, plan, partial, begins).status();
}

v1::CaptureReply Reply(const capture::Reading& reading, int attempts, const std::string& remark) {
  v1::CaptureReply reply;
  reply.set_number(reading.number);
  reply.set_mean_dn(reading.mean.mean_dn);
  reply.set_sigma_dn(reading.mean.sigma_dn);
  reply.set_attempts(attempts);
  reply.set_remark(remark);
  return reply;
}

absl::StatusOr<v1::CaptureReply> TakenBefore(const CaptureSession& session, int number,
                                             const CaptureSpec& spec) {
  if (const auto reading = session.ReadingOf(number)) {
    if (reading->spec == spec) return Reply(*reading, 0, "");
    return absl::AlreadyExistsError(
        Complaint("number", absl::StrCat(number, " was taken of another stimulus"),
                  absl::StrCat("go on with number ", session.Published() + 1)));
  }
  return Rejected("number", absl::StrCat(number, " is marked suspect: the headset slept or dimmed"),
                  absl::StrCat("take it again as number ", session.Published() + 1));
}

absl::StatusOr<v1::CaptureReply> Take(CaptureSession& session, const v1::CaptureRequest& request,
                                      const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const CaptureSpec spec, capture::FromProto(request.capture(), "capture"));
  const int next = session.Published() + 1;
  if (request.number() > 0 && request.number() < next) {
    return TakenBefore(session, request.number(), spec);
  }
  if (request.number() != next) {
    return absl::OutOfRangeError(Complaint("number", absl::StrCat("is ", request.number()),
                                           absl::StrCat("the next one is ", next)));
  }
  EYEBOX_ASSIGN_OR_RETURN(const capture::CaptureFigures figures, session.Take(spec, watcher));
  return Reply(figures.reading, figures.attempts, figures.remark);
}

// A device that failed may be gone for good, a cancelled job is over, a disk that failed is not
// tried again; the rest was a wrong request, and the script may send a right one.
bool EndsSession(const absl::Status& status) {
  return !status.ok() && !absl::IsInvalidArgument(status) && !absl::IsOutOfRange(status) &&
         !absl::IsAlreadyExists(status) && !absl::IsFailedPrecondition(status);
}

absl::Status HoldSession(capture::Rig& rig, const CapturePlan& plan, const fs::path& partial,
                         bool resume, const Assignment& assignment, const Watcher& watcher) {
  EYEBOX_ASSIGN_OR_RETURN(const auto session, resume ? CaptureSession::Resume(rig, partial)
                                                     : CaptureSession::Begin(rig, plan, partial));
  assignment.desk->Open(StimulusDesk::Way::kSession);
  const auto total = static_cast<double>(plan.captures.size());
  while (true) {
    const int done = session->Published();
    EYEBOX_RETURN_IF_ERROR(watcher.Reach(total > 0 ? std::min(1.0, done / total) : 0,
                                         absl::StrCat(done, " captures, waits for the next")));
    EYEBOX_ASSIGN_OR_RETURN(
        const StimulusDesk::Order order,
        assignment.desk->AwaitOrder(watcher.cancelled, TimeoutOf(assignment.request.capture())));
    if (order.finish && done > 0) return absl::OkStatus();
    if (order.finish) {
      return Rejected("recording_id", "was finished without a capture",
                      "create another session and call Capture");
    }
    const auto reply = Take(*session, order.request, watcher);
    assignment.desk->Answer(reply);
    if (EndsSession(reply.status())) return reply.status();
  }
}

// Durable, and never in the place of something else.
absl::Status Publish(const Place& place, const RootFolder& data, const std::string& id) {
  if (renameat2(AT_FDCWD, place.partial.c_str(), AT_FDCWD, place.recording.c_str(),
                RENAME_NOREPLACE) != 0) {
    if (errno != EEXIST) return SystemFailed(id, errno, kRemedy);
    return absl::AlreadyExistsError(
        Complaint("recording_id", id + " appeared while it was captured",
                  "what was captured is in " + PartialName(id) + ": rename one of the two"));
  }
  const OwnedFd folder(open(data.Path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0 || fsync(folder.get()) != 0) return SystemFailed(id, errno, kRemedy);
  return absl::OkStatus();
}

absl::Status WriteResult(const fs::path& recording, const std::string& id, const fs::path& out) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  double frames = 0;
  for (const capture::CaptureEntry& entry : reader->Captures()) frames += entry.frame_count;
  v1::CaptureResult result;
  AddParameter(*result.mutable_parameters(), "captures",
               static_cast<double>(reader->Captures().size()), 0, "1");
  AddParameter(*result.mutable_parameters(), "frames", frames, 0, "1");
  result.set_recording("recordings/" + id);
  EYEBOX_ASSIGN_OR_RETURN(const std::string json, ToJson(result));
  return WriteFileAtomically(out / "result.json", json);
}

absl::Status CaptureAll(const RootFolder& data, const Place& place, bool resume,
                        const Assignment& assignment, const Watcher& watcher) {
  const v1::CaptureWork& work = assignment.request.capture();
  EYEBOX_ASSIGN_OR_RETURN(const CapturePlan plan, PlanOf(work.plan()));
  EYEBOX_ASSIGN_OR_RETURN(const capture::RigConfig config, RigOfWork(data, work));
  EYEBOX_ASSIGN_OR_RETURN(capture::Rig rig, capture::OpenRig(config, SystemClock()));
  return work.session() ? HoldSession(rig, plan, place.partial, resume, assignment, watcher)
                        : CarryOutPlan(rig, plan, place.partial, resume, assignment, watcher);
}

absl::Status CaptureWithClient(const RootFolder& data, const Assignment& assignment,
                               const Watcher& watcher) {
  const v1::CaptureWork& work = assignment.request.capture();
  const std::string& id = work.recording_id();
  const Place place = PlaceOf(data, work);
  std::error_code ignored;
  // Without a header nothing was captured: a kill came before it.
  const bool begun = fs::exists(place.partial / "recording.textproto", ignored);
  const bool goes_on = work.resume() || assignment.started_before;
  if (fs::exists(place.recording, ignored)) {
    // Renamed by this job before the server was killed: nothing is left but to say so.
    if (assignment.started_before && !begun)
      return WriteResult(place.recording, id, assignment.out);
    return absl::AlreadyExistsError(
        Complaint("recording_id", id + " is there already", "give the recording another name"));
  }
  if (begun && !goes_on) {
    return absl::AlreadyExistsError(
        Complaint("recording_id", "an earlier job left captures of " + id,
                  "create the job with resume, or give the recording another name"));
  }
  if (!begun) fs::remove_all(place.partial, ignored);
  EYEBOX_RETURN_IF_ERROR(CaptureAll(data, place, begun, assignment, watcher));
  EYEBOX_RETURN_IF_ERROR(Publish(place, data, id));
  return WriteResult(place.recording, id, assignment.out);
}

}  // namespace

absl::StatusOr<Work> WithCaptures(const fs::path& data, Work others) {
  EYEBOX_ASSIGN_OR_RETURN(RootFolder opened, RootFolder::Open(data));
  const auto root = std::make_shared<const RootFolder>(std::move(opened));
  return [root, others = std::move(others)](const Assignment& assignment, const Watcher& watcher) {
    return assignment.request.has_capture() ? CaptureWithClient(*root, assignment, watcher)
                                            : others(assignment, watcher);
  };
}

}  // namespace eyebox::service
