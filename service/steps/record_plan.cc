#include "service/steps/record_plan.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "capture/base/clock.h"
#include "capture/base/status.h"
#include "capture/recording/recover.h"
#include "capture/recording/remaining.h"
#include "capture/recording/writer.h"
#include "service/steps/capture_log.h"
#include "service/steps/sensor.h"

namespace eyebox::service {
namespace {

bool IsReplay(const capture::Rig& rig) {
  return absl::StartsWith(rig.config.camera_uri, "replay:");
}

capture::RunOptions OptionsFor(const capture::Rig& rig, const std::filesystem::path& recording,
                               const Watcher& watcher, const Settle& settle) {
  capture::RunOptions options;
  options.cancelled = watcher.cancelled;
  options.progress = [&watcher](const capture::RunProgress& progress) {
    if (!watcher.progress) return;
    watcher.progress({static_cast<double>(progress.captures_done) / progress.captures_total,
                      absl::StrCat("recording ", progress.captures_total, " captures")});
  };
  options.published = [recording](const capture::CaptureFigures& figures) {
    return LogCapture(recording, figures);
  };
  if (!IsReplay(rig)) options.settle = settle;
  if (!MeasuresWithDevice(rig)) return options;
  if (!options.settle) options.settle = capture::SettleOptions{};
  options.reopen = [config = rig.config]() -> absl::StatusOr<std::unique_ptr<capture::Camera>> {
    EYEBOX_ASSIGN_OR_RETURN(capture::Rig again, capture::OpenRig(config, SystemClock()));
    return std::move(again.camera);
  };
  return options;
}

absl::Status CheckSameRig(const capture::RecordingHeader& header, const capture::Rig& rig,
                          const std::string& where) {
  const capture::CameraInfo& now = rig.camera->Info();
  const capture::CameraInfo& then = header.camera;
  if (header.rig.camera_uri != rig.config.camera_uri || header.rig.seed != rig.config.seed) {
    return BadInput(
        where,
        absl::StrCat("was begun with ", header.rig.camera_uri, ", seed ", header.rig.seed,
                     ", and is to go on with ", rig.config.camera_uri, ", seed ", rig.config.seed),
        "resume it with the rig that it was begun with");
  }
  if (then.serial == now.serial && then.sensor_size == now.sensor_size &&
      then.significant_bits == now.significant_bits) {
    return absl::OkStatus();
  }
  return BadInput(where,
                  absl::StrCat("was begun with camera ", then.model, " ", then.serial, ", ",
                               then.significant_bits, " bits, and now ", now.model, " ", now.serial,
                               ", ", now.significant_bits, " bits answers"),
                  "connect the camera that it was begun with, set as it was");
}

absl::Status CheckSamePlan(const CapturePlan& recorded, const CapturePlan& asked,
                           const std::string& where) {
  const auto [first, second] = std::ranges::mismatch(recorded.captures, asked.captures);
  if (first == recorded.captures.end() && second == asked.captures.end()) return absl::OkStatus();
  return BadInput(
      where,
      absl::StrCat("follows another plan: ", recorded.captures.size(), " captures instead of ",
                   asked.captures.size(), ", and they differ from capture ",
                   first - recorded.captures.begin() + 1, " on"),
      "resume without options of the plan, or begin another recording");
}

// Otherwise a kill cut it short.
bool IsWhole(const capture::CaptureEntry& entry) { return entry.frame_count == entry.spec.repeats; }

// What an earlier reading is for: readings are compared by the first frame, which is near enough
// and fast to read; a script is told what it was told before, to the last bit.
enum class ReadBy { kFirstFrame, kAllFrames };

absl::StatusOr<std::vector<capture::Reading>> EarlierReadings(capture::RecordingReader& recording,
                                                              ReadBy by) {
  std::vector<capture::Reading> readings;
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (!entry.suspect.empty()) continue;
    std::vector<capture::FrameMean> means;
    const absl::Status status = recording.VisitFrames(entry, [&](const Frame& frame) {
      means.push_back(capture::MeanOf(frame.view));
      return by == ReadBy::kAllFrames ? absl::OkStatus()
                                      : absl::CancelledError("one frame is enough");
    });
    if (means.empty() || by == ReadBy::kAllFrames) EYEBOX_RETURN_IF_ERROR(status);
    if (means.empty()) continue;
    readings.push_back({.number = entry.number,
                        .spec = entry.spec,
                        .mean = by == ReadBy::kAllFrames ? capture::MeanOf(means) : means.front()});
  }
  return readings;
}

// A simulated headset counts its presentations, a replay goes through its captures: so they stand
// where they stood. A capture that was cut short is presented when it is taken again.
absl::Status CatchUp(capture::Rig& rig, const capture::RecordingReader& recording) {
  if (MeasuresWithDevice(rig)) return absl::OkStatus();
  for (const capture::CaptureEntry& entry : recording.Captures()) {
    if (IsWhole(entry)) EYEBOX_RETURN_IF_ERROR(rig.presenter->Present(entry.spec));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<capture::RecordingWriter>> CreateRecording(
    const capture::Rig& rig, const CapturePlan& plan, const std::filesystem::path& recording) {
  const std::filesystem::path sensor = rig.config.sensor;
  capture::RecordingHeader header = capture::MakeHeader(rig, plan, *SystemClock());
  if (!sensor.empty()) {
    EYEBOX_RETURN_IF_ERROR(ReadSensorOf(rig.camera->Info(), sensor).status());
    header.rig.sensor = kSensorFolder;  // the copy stays with the recording
  }
  EYEBOX_ASSIGN_OR_RETURN(auto writer,
                          capture::RecordingWriter::Create(recording, header, SystemClock()));
  if (!sensor.empty()) EYEBOX_RETURN_IF_ERROR(KeepSensor(sensor, recording));
  return writer;
}

}  // namespace

bool MeasuresWithDevice(const capture::Rig& rig) {
  return rig.origin == capture::RecordingOrigin::kCaptured && !IsReplay(rig);
}

absl::StatusOr<capture::RunReport> RecordPlan(capture::Rig& rig, const CapturePlan& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher, const Settle& settle) {
  EYEBOX_ASSIGN_OR_RETURN(const auto writer, CreateRecording(rig, plan, recording));
  return capture::RunPlan(rig, plan, *writer, OptionsFor(rig, recording, watcher, settle));
}

absl::StatusOr<capture::RunReport> ResumePlan(capture::Rig& rig,
                                              const std::optional<CapturePlan>& plan,
                                              const std::filesystem::path& recording,
                                              const Watcher& watcher, const Settle& settle) {
  EYEBOX_RETURN_IF_ERROR(capture::RecoverRecording(recording).status());
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  const capture::RecordingHeader& header = reader->Header();
  EYEBOX_RETURN_IF_ERROR(CheckSameRig(header, rig, recording.string()));
  if (plan) EYEBOX_RETURN_IF_ERROR(CheckSamePlan(header.plan, *plan, recording.string()));
  const CapturePlan left = capture::RemainingCaptures(header.plan, reader->Captures());
  if (left.captures.empty()) return capture::RunReport{};
  capture::RunOptions options = OptionsFor(rig, recording, watcher, settle);
  EYEBOX_ASSIGN_OR_RETURN(options.earlier, EarlierReadings(*reader, ReadBy::kFirstFrame));
  EYEBOX_RETURN_IF_ERROR(CatchUp(rig, *reader));
  EYEBOX_ASSIGN_OR_RETURN(const auto writer, capture::RecordingWriter::Resume(recording));
  return capture::RunPlan(rig, left, *writer, options);
}

absl::StatusOr<std::unique_ptr<CaptureSession>> CaptureSession::Begin(
    capture::Rig& rig, const CapturePlan& plan, const std::filesystem::path& recording,
    const Settle& settle) {
  std::unique_ptr<CaptureSession> session(new CaptureSession(rig, recording, settle));
  EYEBOX_ASSIGN_OR_RETURN(session->writer_, CreateRecording(rig, plan, recording));
  return session;
}

absl::StatusOr<std::unique_ptr<CaptureSession>> CaptureSession::Resume(
    capture::Rig& rig, const std::filesystem::path& recording, const Settle& settle) {
  std::unique_ptr<CaptureSession> session(new CaptureSession(rig, recording, settle));
  EYEBOX_RETURN_IF_ERROR(capture::RecoverRecording(recording).status());
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  EYEBOX_RETURN_IF_ERROR(CheckSameRig(reader->Header(), rig, recording.string()));
  EYEBOX_ASSIGN_OR_RETURN(session->readings_, EarlierReadings(*reader, ReadBy::kAllFrames));
  for (const capture::CaptureEntry& entry : reader->Captures()) {
    if (IsWhole(entry)) session->recorded_.push_back(entry.number);
  }
  EYEBOX_RETURN_IF_ERROR(CatchUp(rig, *reader));
  EYEBOX_ASSIGN_OR_RETURN(session->writer_, capture::RecordingWriter::Resume(recording));
  return session;
}

absl::StatusOr<capture::CaptureFigures> CaptureSession::Take(const CaptureSpec& spec,
                                                             const Watcher& watcher) {
  capture::RunOptions options = OptionsFor(rig_, recording_, watcher, settle_);
  options.progress = nullptr;  // of a plan of one capture: tells nothing
  options.earlier = readings_;
  std::optional<capture::CaptureFigures> taken;
  options.published = [log = options.published, &taken](const capture::CaptureFigures& figures) {
    taken = figures;
    return log(figures);
  };
  const absl::Status run = capture::RunPlan(rig_, {{spec}}, *writer_, options).status();
  // It is on disk, whatever came afterwards.
  if (taken) {
    readings_.push_back(taken->reading);
    recorded_.push_back(taken->reading.number);
  }
  EYEBOX_RETURN_IF_ERROR(run);
  taken->reading.number = Published();
  return *std::move(taken);
}

std::optional<capture::Reading> CaptureSession::ReadingOf(int number) const {
  if (number < 1 || number > Published()) return std::nullopt;
  const auto found = std::ranges::find(readings_, recorded_[number - 1], &capture::Reading::number);
  if (found == readings_.end()) return std::nullopt;
  capture::Reading reading = *found;
  reading.number = number;
  return reading;
}

}  // namespace eyebox::service
