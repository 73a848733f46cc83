#include "capture/run.h"

#include <cmath>
#include <utility>

#include "capture/base/status.h"
#include "capture/base/version.h"
#include "capture/camera/camera_state.h"
#include "capture/run/attempt.h"
#include "capture/run/frame_check.h"

namespace eyebox::capture {
namespace {

absl::Status CheckPlan(const CameraInfo& info, const CapturePlan& plan) {
  if (plan.captures.empty()) return BadInput("plan", "holds no capture", "plan one or more");
  for (size_t i = 0; i < plan.captures.size(); ++i) {
    const CaptureSpec& spec = plan.captures[i];
    const std::string where = "plan, capture " + std::to_string(i + 1);
    if (spec.repeats < 1) {
      return BadInput(where, "asks for " + std::to_string(spec.repeats) + " frames",
                      "ask for one or more");
    }
    const absl::Status settings =
        CheckSettings(info, {.exposure_s = spec.exposure_s, .gain_db = spec.gain_db});
    if (!settings.ok()) {
      return absl::Status(settings.code(), where + ", " + std::string(settings.message()));
    }
  }
  return absl::OkStatus();
}

// One run in progress.
class PlanRunner {
 public:
  PlanRunner(Rig& rig, RecordingWriter& writer, const RunOptions& options)
      : rig_(rig),
        writer_(writer),
        options_(options),
        uri_(rig.camera->Info().uri),
        taker_(rig, writer, options),
        log_(options.plausibility) {
    for (const Reading& reading : options.earlier) log_.Add(reading);
  }

  // Takes one capture until it is complete and plausible, or the attempts are used up.
  absl::Status Take(const CaptureSpec& spec) {
    CaptureFigures figures;
    figures.reading = {.number = writer_.PublishedCount() + 1, .spec = spec, .mean = {}};
    EYEBOX_ASSIGN_OR_RETURN(TakenCapture taken, TakePlausible(spec, figures));
    NoteSamples(taken, figures);
    EYEBOX_RETURN_IF_ERROR(taken.writer->Publish());
    taken.writer.reset();  // closes the capture: only then may the manifest say more of it
    ++report_.captures;
    report_.frames += spec.repeats;
    return Note(std::move(figures));
  }

  RunReport report() && { return std::move(report_); }

 private:
  absl::StatusOr<TakenCapture> TakePlausible(const CaptureSpec& spec, CaptureFigures& figures) {
    for (int implausible = 0;; ++implausible) {
      EYEBOX_ASSIGN_OR_RETURN(TakenCapture taken, TakeComplete(spec, figures));
      figures.reading.mean = taken.mean;
      if (taken.settling) figures.settling = taken.settling;
      const std::string doubt = DoubtOf(spec, taken.mean);
      if (doubt.empty() || implausible >= options_.implausible_attempts) {
        figures.remark = doubt;
        return taken;
      }
      taker_.SettleAnew();
      ++report_.implausible;
      ++report_.captures_taken_again;
      ++figures.attempts;
    }
  }

  void NoteSamples(const TakenCapture& taken, CaptureFigures& figures) {
    if (!rig_.photodiode) return;
    const int64_t lost = taken.writer->samples_lost();
    report_.samples += taken.samples - lost;
    std::string remark;
    if (lost > 0) {
      remark = std::to_string(lost) + " of " + std::to_string(taken.samples) +
               " samples of the photodiode found no room in the file";
    } else if (taken.samples == 0) {
      remark = "the photodiode gave no sample";
    }
    AddRemark(remark, figures);
  }

  static void AddRemark(const std::string& text, CaptureFigures& figures) {
    if (!text.empty()) figures.remark += (figures.remark.empty() ? "" : "; ") + text;
  }

  std::string DoubtOf(const CaptureSpec& spec, const FrameMean& mean) const {
    std::string dimmed = log_.Dimmed(spec, mean);
    return dimmed.empty() ? log_.TooBright(spec, mean) : dimmed;
  }

  absl::StatusOr<TakenCapture> TakeComplete(const CaptureSpec& spec, CaptureFigures& figures) {
    for (int spoilt = 0;; ++figures.attempts, ++report_.captures_taken_again) {
      absl::StatusOr<TakenCapture> taken = taker_.Attempt(spec);
      if (taken.ok()) return taken;
      if (taker_.camera_lost() && MayReopen()) {
        EYEBOX_RETURN_IF_ERROR(Reopen(taken.status()));
      } else if (!absl::IsAborted(taken.status())) {
        return taken;
      } else if (++spoilt == options_.attempts) {
        ++report_.captures_taken_again;
        return DeviceFailed("capture " + std::to_string(figures.reading.number),
                            "failed " + std::to_string(options_.attempts) +
                                " times; the last time " + std::string(taken.status().message()),
                            "check cable, bandwidth and trigger of " + uri_ + " and capture again");
      }
    }
  }

  bool MayReopen() const { return options_.reopen && report_.cameras_reopened == 0; }

  // Its objects are never used again: a lost camera answers none of them.
  absl::Status Reopen(const absl::Status& why) {
    const CameraInfo before = rig_.camera->Info();
    rig_.camera.reset();
    EYEBOX_ASSIGN_OR_RETURN(rig_.camera, options_.reopen());
    const CameraInfo& now = rig_.camera->Info();
    if (now.sensor_size != before.sensor_size || now.significant_bits != before.significant_bits ||
        now.serial != before.serial) {
      return DeviceFailed(uri_, "was lost, and another camera answers in its place",
                          "connect the camera " + before.model + " " + before.serial + " again");
    }
    ++report_.cameras_reopened;
    report_.remarks.push_back("capture " + std::to_string(writer_.PublishedCount() + 1) +
                              ": the camera was lost and opened again (" +
                              std::string(why.message()) + ")");
    taker_.CameraIsBack();
    return absl::OkStatus();
  }

  absl::Status Note(CaptureFigures figures) {
    const CaptureSpec& spec = figures.reading.spec;
    const std::string dimmed = log_.Dimmed(spec, figures.reading.mean);
    const std::string earlier = log_.EarlierTooBright(spec, figures.reading.mean);
    AddRemark(earlier, figures);
    if (figures.settling && !figures.settling->settled) {
      AddRemark("it had not settled after " + std::to_string(figures.settling->seconds) + " s",
                figures);
    }
    const std::string capture = "capture " + std::to_string(figures.reading.number);
    if (!figures.remark.empty()) report_.remarks.push_back(capture + ": " + figures.remark);
    if (options_.published) EYEBOX_RETURN_IF_ERROR(options_.published(figures));
    if (!dimmed.empty()) return Slept(capture, dimmed);
    log_.Add(std::move(figures.reading));
    return absl::OkStatus();
  }

  absl::Status Slept(const std::string& capture, const std::string& how) {
    const int suspect = log_.LastReference() + 1;
    EYEBOX_RETURN_IF_ERROR(writer_.SuspectSince(suspect, how));
    return DeviceFailed(capture,
                        how + ": the headset slept or dimmed, and what was taken from capture " +
                            std::to_string(suspect) + " on is marked suspect",
                        "wake it, keep it from sleeping and resume the recording: the suspect "
                        "captures are taken again");
  }

  Rig& rig_;
  RecordingWriter& writer_;
  const RunOptions& options_;
  const std::string uri_;
  CaptureTaker taker_;
  ReadingLog log_;
  RunReport report_;
};

absl::Status RunCaptures(PlanRunner& runner, const CapturePlan& plan, const RunOptions& options) {
  const int total = static_cast<int>(plan.captures.size());
  for (int i = 0; i < total; ++i) {
    const CaptureSpec& spec = plan.captures[static_cast<size_t>(i)];
    if (options.progress) options.progress({i, total, spec});
    EYEBOX_RETURN_IF_ERROR(runner.Take(spec));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status RunOptions::Validate() const {
  if (attempts < 1) return BadInput("RunOptions.attempts", "is below 1", "allow one or more");
  if (implausible_attempts < 0) {
    return BadInput("RunOptions.implausible_attempts", "is below 0", "allow none or more");
  }
  if (frames_per_acknowledgement < 1) {
    return BadInput("RunOptions.frames_per_acknowledgement", "is below 1", "give one or more");
  }
  if (settle) EYEBOX_RETURN_IF_ERROR(settle->Validate());
  EYEBOX_RETURN_IF_ERROR(plausibility.Validate());
  if (!std::isfinite(photodiode_rate_hz) || photodiode_rate_hz <= 0) {
    return BadInput("RunOptions.photodiode_rate_hz", "is " + std::to_string(photodiode_rate_hz),
                    "give a positive rate");
  }
  if (clock == nullptr) return BadInput("RunOptions.clock", "is missing", "give the rig's clock");
  if (exposure_tolerance >= 0 && exposure_tolerance < 1) return absl::OkStatus();
  return BadInput("RunOptions.exposure_tolerance", "is " + std::to_string(exposure_tolerance),
                  "give a fraction from 0 up to 1");
}

RecordingHeader MakeHeader(const Rig& rig, const CapturePlan& plan, const Clock& clock) {
  RecordingHeader header;
  header.origin = rig.origin;
  header.rig = rig.config;
  header.camera = rig.camera->Info();
  header.geometry = rig.camera->Info().geometry;
  header.camera_settings = StateOf(rig);
  header.plan = plan;
  header.software_version = std::string(kVersion);
  header.created_real_ns = clock.RealNs();
  return header;
}

absl::StatusOr<RunReport> RunPlan(Rig& rig, const CapturePlan& plan, RecordingWriter& writer,
                                  const RunOptions& options) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_RETURN_IF_ERROR(CheckPlan(rig.camera->Info(), plan));
  PlanRunner runner(rig, writer, options);
  const absl::Status run = RunCaptures(runner, plan, options);
  // A camera that was lost and could not be opened again is not there any more.
  const absl::Status stop = rig.camera ? rig.camera->Stop() : absl::OkStatus();
  const absl::Status photodiode = rig.photodiode ? rig.photodiode->Stop() : absl::OkStatus();
  if (!run.ok()) return run;
  if (!stop.ok()) return stop;
  if (!photodiode.ok()) return photodiode;
  return std::move(runner).report();
}

}  // namespace eyebox::capture
