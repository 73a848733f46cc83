#include "service/preflight/preflight.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "capture/base/status.h"
#include "service/preflight/black_level.h"
#include "service/preflight/exposure_ladder.h"
#include "service/preflight/frame_figures.h"
#include "service/preflight/frame_taker.h"
#include "service/preflight/ladder_range.h"
#include "service/preflight/moire.h"
#include "service/preflight/read_back.h"
#include "service/preflight/refresh.h"
#include "service/preflight/rolling_shutter.h"
#include "service/preflight/stale_frames.h"

namespace eyebox::service {
namespace {

constexpr double kSaturatedShare = 0.95;  // of full scale
constexpr double kProbeS = 4e-3;  // about half a period of common displays, never a whole one
constexpr int kProbeFrames = 4;

using Strobe = std::optional<absl::StatusOr<capture::StrobeMeasurement>>;

// The state of one preflight; its steps are called in the order in which they stand.
class Preflight {
 public:
  Preflight(capture::Rig& rig, const PreflightOptions& options)
      : options_(options),
        taker_(rig, options.settle_frames),
        size_(rig.camera->Info().sensor_size),
        limit_dn_(kSaturatedShare * (std::exp2(rig.camera->Info().significant_bits) - 1)) {}

  // An exposure that the camera cannot have is found before any light is measured.
  absl::Status SetEveryExposure() {
    for (const double exposure_s : options_.exposures_s) {
      EYEBOX_RETURN_IF_ERROR(taker_.Set(exposure_s));
    }
    return absl::OkStatus();
  }

  absl::Status MeasureStrobe(capture::Photodiode* photodiode) {
    if (photodiode == nullptr) return absl::OkStatus();
    EYEBOX_RETURN_IF_ERROR(taker_.ShowGrey(1));
    strobe_ = MeasureRefresh(*photodiode);
    if (strobe_->ok() && (*strobe_)->strobed) period_s_ = (*strobe_)->period_s;
    return absl::OkStatus();
  }

  absl::Status TakeLight() {
    EYEBOX_ASSIGN_OR_RETURN(range_, ChooseLadder(taker_, period_s_, options_.longest_ladder_s));
    EYEBOX_ASSIGN_OR_RETURN(brightest_, taker_.TakeSettled(range_.Longest(), options_.frames));
    mask_ = PixelsBelow(brightest_, limit_dn_);
    light_.clear();
    for (const double exposure_s : range_.exposures_s) {
      EYEBOX_ASSIGN_OR_RETURN(const auto frames, taker_.TakeSettled(exposure_s, options_.frames));
      light_.push_back(MeanOfField(frames, mask_));
    }
    return absl::OkStatus();
  }

  absl::Status ChangeExposure() {
    const double low_s = range_.exposures_s[kLadderRungs - 3];
    const double high_s = range_.Longest();
    for (const auto& [old_s, new_s] : {std::pair(low_s, high_s), std::pair(high_s, low_s)}) {
      ExposureChange change = {.old_exposure_s = old_s, .new_exposure_s = new_s};
      EYEBOX_ASSIGN_OR_RETURN(const auto old_frames, taker_.TakeSettled(old_s, options_.frames));
      EYEBOX_ASSIGN_OR_RETURN(auto frames, taker_.TakeFirst(new_s, options_.settle_frames));
      change.first_means_dn = MeansOf(frames, mask_);
      EYEBOX_ASSIGN_OR_RETURN(frames, taker_.TakeSettled(new_s, options_.frames));
      change.old_means_dn = MeansOf(old_frames, mask_);
      change.new_means_dn = MeansOf(frames, mask_);
      changes_.push_back(std::move(change));
    }
    return absl::OkStatus();
  }

  absl::Status ProbeShutter() {
    const double wanted_s = period_s_ > 0 ? period_s_ / 2 : kProbeS;
    probe_s_ = std::clamp(wanted_s, range_.Shortest(), range_.Longest());
    if (period_s_ > 0) probe_s_ = std::max(wanted_s, taker_.info().exposure_min_s);
    EYEBOX_ASSIGN_OR_RETURN(const auto frames, taker_.TakeSettled(probe_s_, kProbeFrames));
    for (const Counts& frame : frames) rows_.push_back(RowMeans(frame, size_));
    return absl::OkStatus();
  }

  absl::Status TakeDark() {
    EYEBOX_RETURN_IF_ERROR(taker_.ShowDark());
    EYEBOX_ASSIGN_OR_RETURN(const auto probe, taker_.TakeSettled(probe_s_, options_.frames));
    SubtractRows(probe);
    for (const double exposure_s : range_.exposures_s) {
      EYEBOX_ASSIGN_OR_RETURN(darkest_, taker_.TakeSettled(exposure_s, options_.frames));
      dark_.push_back(MeanOfField(darkest_, mask_));
      if (exposure_s != range_.Shortest()) continue;
      for (const Counts& frame : darkest_) {
        shortest_dark_.insert(shortest_dark_.end(), frame.begin(), frame.end());
      }
    }
    return taker_.Stop();
  }

  std::vector<Check> Judge() const {
    // Neighbours in a mosaic differ by colour: one colour alone is looked at.
    const int stride = taker_.info().pixel_format.starts_with("Bayer") ? 2 : 1;
    return {CheckReadBack(taker_.read_backs()),
            CheckExposureLadder(Rungs()),
            CheckStaleFrames(changes_),
            CheckBlackLevel(shortest_dark_, taker_.info().significant_bits),
            CheckRefresh(strobe_),
            CheckWholePeriods(strobe_, options_.exposures_s),
            CheckRollingShutter(rows_),
            CheckMoire(MeanField(brightest_, darkest_, size_, stride),
                       {.camera_px_per_display_px = options_.camera_px_per_display_px})};
  }

 private:
  void SubtractRows(std::span<const Counts> dark) {
    std::vector<double> mean(static_cast<size_t>(size_.height_px));
    for (const Counts& frame : dark) {
      const std::vector<double> rows = RowMeans(frame, size_);
      for (size_t y = 0; y < mean.size(); ++y)
        mean[y] += rows[y] / static_cast<double>(dark.size());
    }
    for (std::vector<double>& rows : rows_) {
      for (size_t y = 0; y < mean.size(); ++y) rows[y] -= mean[y];
    }
  }

  std::vector<LadderRung> Rungs() const {
    // Where more than half of the field is saturated in the longest, its rest tells little.
    const auto unsaturated = std::ranges::count(mask_, uint8_t{1});
    const bool blinded = 2 * static_cast<size_t>(unsaturated) < mask_.size();
    std::vector<LadderRung> rungs;
    for (size_t i = 0; i < kLadderRungs; ++i) {
      rungs.push_back(
          {.exposure_s = range_.exposures_s[i],
           .signal_dn = light_[i].mean_dn - dark_[i].mean_dn,
           .sigma_dn = std::hypot(light_[i].sigma_dn, dark_[i].sigma_dn),
           .saturated = blinded || light_[i].mean_dn >= limit_dn_,
           .pixel_sigma_dn = std::hypot(light_[i].pixel_sigma_dn, dark_[i].pixel_sigma_dn)});
    }
    return rungs;
  }

  const PreflightOptions& options_;
  FrameTaker taker_;
  const ImageSize size_;
  const double limit_dn_;
  Strobe strobe_;
  double period_s_ = 0;  // of a display that flashes, else 0
  LadderRange range_;
  Mask mask_;
  std::vector<FieldMean> light_;  // one a rung
  std::vector<FieldMean> dark_;
  std::vector<Counts> brightest_;  // frames of the longest exposure
  std::vector<Counts> darkest_;
  Counts shortest_dark_;
  std::vector<ExposureChange> changes_;
  double probe_s_ = 0;
  std::vector<std::vector<double>> rows_;
};

absl::Status Measure(Preflight& preflight, capture::Photodiode* photodiode,
                     const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0, "settings"));
  EYEBOX_RETURN_IF_ERROR(preflight.SetEveryExposure());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.05, "refresh"));
  EYEBOX_RETURN_IF_ERROR(preflight.MeasureStrobe(photodiode));
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.2, "exposure ladder"));
  EYEBOX_RETURN_IF_ERROR(preflight.TakeLight());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.55, "changes of exposure"));
  EYEBOX_RETURN_IF_ERROR(preflight.ChangeExposure());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.7, "shutter"));
  EYEBOX_RETURN_IF_ERROR(preflight.ProbeShutter());
  EYEBOX_RETURN_IF_ERROR(watcher.Reach(0.75, "dark"));
  return preflight.TakeDark();
}

}  // namespace

absl::Status PreflightOptions::Validate() const {
  if (frames < 2) return BadInput("PreflightOptions.frames", "is below 2", "take two or more");
  if (settle_frames < 1) {
    return BadInput("PreflightOptions.settle_frames", "is below 1", "drop one or more");
  }
  if (!(longest_ladder_s > 0) || !std::isfinite(longest_ladder_s)) {
    return BadInput("PreflightOptions.longest_ladder_s", "is " + std::to_string(longest_ladder_s),
                    "give seconds above 0");
  }
  if (camera_px_per_display_px &&
      !(*camera_px_per_display_px > 0 && std::isfinite(*camera_px_per_display_px))) {
    return BadInput("PreflightOptions.camera_px_per_display_px",
                    "is " + std::to_string(*camera_px_per_display_px), "give a ratio above 0");
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<Check>> RunPreflight(capture::Rig& rig, capture::Photodiode* photodiode,
                                                const PreflightOptions& options,
                                                const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  Preflight preflight(rig, options);
  const absl::Status measured = Measure(preflight, photodiode, watcher);
  const absl::Status stopped = rig.camera->Stop();
  if (!measured.ok()) return measured;
  if (!stopped.ok()) return stopped;
  std::vector<Check> checks = preflight.Judge();
  if (watcher.progress) watcher.progress({1, "done"});
  return checks;
}

}  // namespace eyebox::service
