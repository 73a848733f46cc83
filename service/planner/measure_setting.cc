#include "service/planner/measure_setting.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "capture/base/status.h"
#include "fit/cube/goal.h"
#include "optics/reduce/reduce_level.h"
#include "optics/uniformity/smooth_field.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

constexpr int kErrorPoints = 33;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
const optics::ReduceOptions kGrey{.colour_period_px = 1};

class StopWatch {
 public:
  explicit StopWatch(const Clock& clock) : clock_(clock), start_ns_(clock.MonotonicNs()) {}
  double Lap() {
    const int64_t now_ns = clock_.MonotonicNs();
    return 1e-9 * static_cast<double>(now_ns - std::exchange(start_ns_, now_ns));
  }

 private:
  const Clock& clock_;
  int64_t start_ns_;
};

Stimulus Grey(double drive) {
  Stimulus stimulus;
  stimulus.drive = DriveRgb{drive, drive, drive};
  return stimulus;
}

absl::StatusOr<optics::ReducedLevel> Reduce(FrameSource& source, const Stimulus& stimulus,
                                            const std::vector<int>& frames,
                                            const optics::Calibration& calibration) {
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks, source.Take(stimulus, frames));
  return optics::ReduceLevel(stacks, calibration, kGrey);
}

// Which channels a series drives.
using Channels = DriveRgb;
constexpr Channels kGreyChannels = {1, 1, 1};
constexpr Channels kPrimaries[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

struct Levels {
  fit::LevelSeries series;
  optics::MeasuredImage brightest;
};

absl::StatusOr<Levels> ReduceLevels(FrameSource& source, const Setting& setting,
                                    const Channels& channels,
                                    const optics::Calibration& calibration) {
  Levels levels;
  std::vector<DiskReading> readings;
  for (const LevelFrames& level : setting.levels) {
    Stimulus stimulus;
    stimulus.drive =
        DriveRgb{level.drive * channels[0], level.drive * channels[1], level.drive * channels[2]};
    EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel reduced,
                            Reduce(source, stimulus, level.frames, calibration));
    readings.push_back(ReadReferenceDisk(reduced.luminance, calibration, level.drive));
    levels.brightest = std::move(reduced.luminance.image);
  }
  // The scale is common to all that is compared here, so it is left out of the covariance.
  EYEBOX_ASSIGN_OR_RETURN(levels.series, MakeLevelSeries(readings, 0, "cd/m2", setting.name));
  levels.series.scale_relative_sigma = 0;
  return levels;
}

// Means of the valid pixels of each block of b x b.
std::vector<double> BlockMeans(const optics::MeasuredImage& white, int b,
                               const std::vector<size_t>& region) {
  const int width = white.size().width_px;
  const int columns = (width + b - 1) / b;
  const int rows = (white.size().height_px + b - 1) / b;
  std::vector<double> sums(static_cast<size_t>(columns) * rows, 0);
  std::vector<int> counts(sums.size(), 0);
  const auto block_of = [&](size_t i) {
    const auto x = static_cast<int>(i % static_cast<size_t>(width));
    const auto y = static_cast<int>(i / static_cast<size_t>(width));
    return static_cast<size_t>(y / b) * columns + static_cast<size_t>(x / b);
  };
  for (size_t i = 0; i < white.mask.pixels().size(); ++i) {
    if (white.mask.pixels()[i] != 0) continue;
    sums[block_of(i)] += white.value.pixels()[i];
    ++counts[block_of(i)];
  }
  std::vector<double> means;
  for (const size_t i : region) {
    const size_t block = block_of(i);
    means.push_back(counts[block] > 0 ? sums[block] / counts[block] : kNoValue);
  }
  return means;
}

// Luminance of the white field at the pixels of the region, as the tier has it.
absl::StatusOr<std::vector<double>> WhiteOf(const Setting& setting,
                                            const optics::MeasuredImage& white, double reference,
                                            const std::vector<size_t>& region) {
  if (setting.tier == FieldTier::kNone) return std::vector<double>(region.size(), reference);
  if (setting.tier == FieldTier::kBlocks) return BlockMeans(white, setting.tier_size, region);
  EYEBOX_ASSIGN_OR_RETURN(
      const optics::SmoothField smooth,
      optics::FitSmoothField(white, optics::FieldModel::kPolynomial, setting.tier_size));
  const Image<float> values = smooth.Values();
  std::vector<double> of_region;
  for (const size_t i : region) of_region.push_back(values.pixels()[i]);
  return of_region;
}

absl::StatusOr<double> MeanAtReference(const optics::LuminanceImage& luminance,
                                       const optics::Calibration& calibration) {
  double sum = 0;
  int count = 0;
  for (const double value : ReadReferenceDisk(luminance, calibration, 1).luminance) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  if (count > 0) return sum / count;
  return Rejected("white", "no pixel at the image centre has a value", "choose another exposure");
}

absl::StatusOr<double> ReadMiddle(FrameSource& source, const Stimulus& stimulus,
                                  const std::vector<int>& frames,
                                  const optics::Calibration& calibration) {
  EYEBOX_ASSIGN_OR_RETURN(const optics::ReducedLevel reduced,
                          Reduce(source, stimulus, frames, calibration));
  return MeanAtReference(reduced.luminance, calibration);
}

absl::StatusOr<double> MeasureGlareFactor(FrameSource& source, const Setting& setting,
                                          const Need& need,
                                          const optics::Calibration& calibration) {
  Stimulus disk = Grey(1);
  disk.pattern = StimulusPattern::kDisk;
  disk.diameter_deg = need.disk_deg;
  EYEBOX_ASSIGN_OR_RETURN(const double amid,
                          ReadMiddle(source, disk, DiskFrames(setting), calibration));
  EYEBOX_ASSIGN_OR_RETURN(const double full,
                          ReadMiddle(source, Grey(1), setting.levels.back().frames, calibration));
  return amid / full;
}

// Of Setting::shown: each is read as the scene shows it.
absl::StatusOr<Measured> MeasureShown(FrameSource& source, const Setting& setting, const Need& need,
                                      const std::vector<size_t>& region,
                                      const optics::Calibration& calibration, const Clock& clock) {
  Measured measured;
  StopWatch watch(clock);
  optics::MeasuredImage brightest;
  double reference = 0;
  for (const ShownFrames& thing : setting.shown) {
    Stimulus stimulus;
    stimulus.drive = thing.drive;
    if (need.disk_deg > 0) stimulus.pattern = StimulusPattern::kDisk;
    stimulus.diameter_deg = need.disk_deg;
    EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel reduced,
                            Reduce(source, stimulus, thing.frames, calibration));
    EYEBOX_ASSIGN_OR_RETURN(reference, MeanAtReference(reduced.luminance, calibration));
    measured.readings.emplace_back(thing.drive, reference);
    brightest = std::move(reduced.luminance.image);
  }
  if (!setting.levels.empty()) {
    EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel reduced,
                            Reduce(source, Grey(1), setting.levels.back().frames, calibration));
    EYEBOX_ASSIGN_OR_RETURN(reference, MeanAtReference(reduced.luminance, calibration));
    brightest = std::move(reduced.luminance.image);
  }
  measured.seconds.reduce = watch.Lap();
  EYEBOX_ASSIGN_OR_RETURN(measured.field, WhiteOf(setting, brightest, reference, region));
  for (double& value : measured.field) value /= reference;
  measured.seconds.field = watch.Lap();
  return measured;
}

}  // namespace

std::vector<size_t> RegionPixels(ImageSize size, const PinholeGeometry& geometry,
                                 double radius_deg) {
  const double radius_px = geometry.focal_length_px * std::tan(radius_deg * std::numbers::pi / 180);
  std::vector<size_t> pixels;
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      if (std::hypot(x - geometry.principal_x_px, y - geometry.principal_y_px) > radius_px) {
        continue;
      }
      pixels.push_back(static_cast<size_t>(y) * size.width_px + x);
    }
  }
  return pixels;
}

absl::StatusOr<Measured> MeasureSetting(FrameSource& source, const Setting& setting,
                                        const Need& need, const std::vector<size_t>& region,
                                        const Clock& clock) {
  EYEBOX_ASSIGN_OR_RETURN(const auto* const calibration,
                          source.CalibrationOf(setting.calibration_frames));
  if (!setting.shown.empty()) {
    return MeasureShown(source, setting, need, region, *calibration, clock);
  }
  Measured measured;
  StopWatch watch(clock);
  const std::span<const Channels> series =
      setting.primaries ? std::span<const Channels>(kPrimaries) : std::span(&kGreyChannels, 1);
  optics::MeasuredImage white;
  for (const Channels& channels : series) {
    EYEBOX_ASSIGN_OR_RETURN(Levels levels, ReduceLevels(source, setting, channels, *calibration));
    white = std::move(levels.brightest);
    measured.seconds.reduce += watch.Lap();
    EYEBOX_ASSIGN_OR_RETURN(
        measured.fits.emplace_back(),
        fit::FitActivation(levels.series, setting.model, fit::Weighting::kMeasuredSigma));
    measured.seconds.fit += watch.Lap();
    EYEBOX_ASSIGN_OR_RETURN(
        measured.tables.emplace_back(),
        fit::DesignTable(measured.fits.back().activation, fit::TableTarget::kHdrp,
                         setting.table_size, {.u_from = need.u_from}));
    measured.seconds.table += watch.Lap();
  }
  double reference = measured.fits[0].activation.Luminance(1);
  if (setting.primaries) {
    EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel reduced,
                            Reduce(source, Grey(1), setting.levels.back().frames, *calibration));
    EYEBOX_ASSIGN_OR_RETURN(reference, MeanAtReference(reduced.luminance, *calibration));
    white = std::move(reduced.luminance.image);
  }
  EYEBOX_ASSIGN_OR_RETURN(measured.field, WhiteOf(setting, white, reference, region));
  for (double& value : measured.field) value /= reference;
  measured.seconds.field = watch.Lap();
  if (need.disk_deg > 0 && setting.disk_frames > 0) {
    EYEBOX_ASSIGN_OR_RETURN(measured.glare_factor,
                            MeasureGlareFactor(source, setting, need, *calibration));
    measured.seconds.glare = watch.Lap();
  }
  return measured;
}

std::vector<double> LooksAt(const Need& need) {
  if (!need.grey_u.empty()) return need.grey_u;
  std::vector<double> points;
  for (int i = 0; i < kErrorPoints; ++i) {
    points.push_back(std::pow(need.u_from, 1 - i / (kErrorPoints - 1.0)));
  }
  return points;
}

double StatedLuminance(std::span<const fit::ActivationFit> fits, const DriveRgb& drive) {
  double sum = 0;
  double black = 0;
  for (size_t c = 0; c < fits.size(); ++c) {
    sum += fits[c].activation.Luminance(drive[c]);
    black += fits[c].activation.minimum_luminance / static_cast<double>(fits.size());
  }
  return sum - (static_cast<double>(fits.size()) - 1) * black;
}

std::vector<double> DeparturesOf(const fit::Activation& fitted, const Truth& truth,
                                 const Need& need) {
  std::vector<double> departures;
  for (const double u : LooksAt(need)) {
    const double drive = fit::DriveForLuminance(fitted, u * fitted.Luminance(1));
    departures.push_back(truth.relative_luminance({drive, drive, drive}) / u - 1);
  }
  return departures;
}

namespace {

// Shown over stated luminance at the reference point, of each thing that is looked at. The truth
// is relative to white there.
std::vector<double> ShownOverStated(const Measured& measured, const Truth& truth,
                                    const Need& need) {
  std::vector<double> ratios;
  for (const auto& [drive, luminance] : measured.readings) {
    ratios.push_back(truth.relative_luminance(drive) / luminance);
  }
  if (!ratios.empty()) return ratios;
  if (need.colours.empty()) {
    const double white = measured.fits[0].activation.Luminance(1);
    for (const double u : LooksAt(need)) {
      const double drive = fit::DriveThroughTable(measured.tables[0], u);
      ratios.push_back(truth.relative_luminance({drive, drive, drive}) / (u * white));
    }
    return ratios;
  }
  for (const DriveRgb& u : need.colours) {
    DriveRgb drive;
    for (size_t c = 0; c < u.size(); ++c) {
      drive[c] = fit::DriveThroughTable(measured.tables[c], u[c]);
    }
    ratios.push_back(truth.relative_luminance(drive) / StatedLuminance(measured.fits, drive));
  }
  return ratios;
}

}  // namespace

std::vector<double> ErrorsOf(const Measured& measured, const Truth& truth, const Need& need,
                             const std::vector<size_t>& region) {
  const double common = truth.stated_over_true * truth.glare_factor / measured.glare_factor;
  const std::vector<double> ratios = ShownOverStated(measured, truth, need);
  std::vector<double> errors;
  for (size_t p = 0; p < region.size(); ++p) {
    const double at = truth.white.pixels()[region[p]] / measured.field[p];
    if (!std::isfinite(at)) continue;
    for (const double ratio : ratios) errors.push_back(common * at * ratio - 1);
  }
  return errors;
}

}  // namespace eyebox::service
