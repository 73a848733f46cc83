#include "service/planner/recording_measurement.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/clock.h"
#include "capture/base/random.h"
#include "capture/base/status.h"
#include "fit/activation/activation_problem.h"
#include "optics/reduce/reduce_level.h"
#include "service/planner/measure_setting.h"

namespace eyebox::service {
namespace {

const optics::ReduceOptions kGrey{.colour_period_px = 1};

CaptureSpec GreyScene(double drive) {
  CaptureSpec scene;
  scene.stimulus.drive = DriveRgb{drive, drive, drive};
  return scene;
}

CaptureSpec DiskScene(double diameter_deg) {
  CaptureSpec scene = GreyScene(1);
  scene.stimulus.pattern = StimulusPattern::kDisk;
  scene.stimulus.diameter_deg = diameter_deg;
  return scene;
}

std::string Describe(const CaptureSpec& scene) {
  if (scene.kind == FrameKind::kDark) return "darks";
  if (scene.kind == FrameKind::kFlat) return "flats";
  std::string words = scene.stimulus.pattern == StimulusPattern::kFullField
                          ? "full fields"
                          : absl::StrFormat("disks of %g deg", scene.stimulus.diameter_deg);
  return absl::StrFormat("%s of drive %s", words,
                         absl::StrJoin(scene.stimulus.drive.value_or(DriveRgb{}), " "));
}

// Everything that the source has, told as well as it can be.
Setting Thorough(const Stock& stock, size_t exposures, double disk_deg) {
  Setting setting;
  setting.name = "the other half of the frames";
  for (const double drive : stock.drives) {
    setting.levels.push_back({drive, std::vector<int>(exposures, stock.frames)});
  }
  const size_t for_spline =
      fit::ActivationProblem{fit::ActivationModel::kMonotoneSpline, {}}.FewestDrives();
  setting.model = stock.drives.size() >= for_spline ? fit::ActivationModel::kMonotoneSpline
                                                    : fit::ActivationModel::kGammaWithCutoff;
  setting.tier = FieldTier::kBlocks;
  setting.tier_size = 1;
  setting.calibration_frames = stock.calibration_frames;
  setting.disk_frames = disk_deg > 0 ? stock.disk_frames : 0;
  return setting;
}

double MeanRelativeVariance(const optics::MeasuredImage& image) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    if (image.mask.pixels()[i] != 0) continue;
    const double value = image.value.pixels()[i];
    sum += image.variance.pixels()[i] / (value * value);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace

RecordingMeasurement::RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames)
    : RecordingMeasurement(std::move(frames), 0, Share::kAll) {}

RecordingMeasurement::RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames,
                                           uint64_t seed)
    : RecordingMeasurement(std::move(frames), seed, Share::kFirstHalf) {}

RecordingMeasurement::RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames,
                                           uint64_t seed, Share share)
    : frames_(std::move(frames)), seed_(seed), share_(share) {
  stock_.drives = frames_->drives;
  stock_.disks_deg = frames_->disks_deg;
  stock_.calibration_frames = std::min(CountOf(DarkScene()), CountOf(FlatScene()));
  stock_.frames = CountOf(GreyScene(1));
  for (const double drive : stock_.drives) {
    stock_.frames = std::min(stock_.frames, CountOf(GreyScene(drive)));
  }
  for (const double disk_deg : stock_.disks_deg) {
    const int count = CountOf(DiskScene(disk_deg));
    stock_.disk_frames = stock_.disk_frames > 0 ? std::min(stock_.disk_frames, count) : count;
  }
}

std::vector<size_t> RecordingMeasurement::OrderOf(const CaptureSpec& scene, size_t exposure) const {
  std::vector<size_t> order(frames_->Of(scene, exposure).size());
  std::iota(order.begin(), order.end(), size_t{0});
  if (share_ == Share::kAll) return order;
  RandomStream random({seed_, MixedKey(SceneKeyOf(scene)), exposure});
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.Below(i)]);
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
  return share_ == Share::kFirstHalf ? std::vector<size_t>(order.begin(), middle)
                                     : std::vector<size_t>(middle, order.end());
}

int RecordingMeasurement::CountOf(const CaptureSpec& scene) const {
  size_t count = frames_->Of(scene, 0).size();
  for (size_t k = 1; k < frames_->exposures_s.size(); ++k) {
    count = std::min(count, frames_->Of(scene, k).size());
  }
  if (share_ == Share::kAll) return static_cast<int>(count);
  return static_cast<int>(share_ == Share::kFirstHalf ? count / 2 : count - count / 2);
}

absl::StatusOr<std::vector<HeldFrames::Counts>> RecordingMeasurement::FramesOf(
    const CaptureSpec& scene, size_t exposure, int count) {
  const std::vector<size_t> order = OrderOf(scene, exposure);
  if (order.size() < static_cast<size_t>(count)) {
    return Rejected(frames_->name,
                    absl::StrFormat("%d %s of %g s are asked for, and %d are there", count,
                                    Describe(scene), frames_->exposures_s[exposure], order.size()),
                    "record more of them");
  }
  std::vector<Counts> counts;
  for (int i = 0; i < count; ++i) {
    counts.emplace_back(frames_->Of(scene, exposure)[order[static_cast<size_t>(i)]]);
  }
  return counts;
}

CaptureSpec RecordingMeasurement::FlatScene() const {
  CaptureSpec scene;
  scene.kind = FrameKind::kFlat;
  return scene;
}

optics::KnownLuminance RecordingMeasurement::StatedFlat() const {
  return {frames_->flat_luminance_cd_m2, frames_->flat_relative_sigma};
}

absl::StatusOr<Truth> RecordingMeasurement::TruthFor(double disk_deg) {
  const auto known = truths_.find(disk_deg);
  if (known != truths_.end()) return known->second;
  if (share_ == Share::kAll) {
    return absl::UnimplementedError(frames_->name + ": all of its frames are in use");
  }
  RecordingMeasurement rest(frames_, seed_, Share::kSecondHalf);
  const size_t exposures = ExposuresS().size();
  const Setting setting = Thorough(rest.stock_, exposures, disk_deg);
  std::vector<size_t> everywhere(Size().PixelCount());
  std::iota(everywhere.begin(), everywhere.end(), size_t{0});
  EYEBOX_ASSIGN_OR_RETURN(
      const Measured measured,
      MeasureSetting(rest, setting, {.disk_deg = disk_deg}, everywhere, *SystemClock()));
  EYEBOX_ASSIGN_OR_RETURN(const auto* const calibration,
                          rest.CalibrationOf(setting.calibration_frames));
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks,
                          rest.Take(GreyScene(1).stimulus, setting.levels.back().frames));
  EYEBOX_ASSIGN_OR_RETURN(const optics::ReducedLevel white,
                          optics::ReduceLevel(stacks, *calibration, kGrey));
  const fit::Activation activation = measured.fits[0].activation;
  Truth truth;
  truth.white = Image<double>(Size());
  for (size_t i = 0; i < everywhere.size(); ++i) {
    truth.white.pixels()[i] = measured.field[i] * activation.Luminance(1);
  }
  truth.relative_luminance = [activation](const DriveRgb& drive) {
    return activation.Luminance(drive[0]) / activation.Luminance(1);
  };
  truth.glare_factor = measured.glare_factor;
  truth.white_relative_variance = MeanRelativeVariance(white.luminance.image);
  return truths_.emplace(disk_deg, std::move(truth)).first->second;
}

}  // namespace eyebox::service
