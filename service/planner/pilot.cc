#include "service/planner/pilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/base/status.h"
#include "optics/reduce/reduce_level.h"
#include "service/planner/measure_setting.h"
#include "service/steps/reference_disk.h"

namespace eyebox::service {
namespace {

constexpr int kSmoothOrder = 8;  // more than any setting takes
constexpr double kPixelsPerMpx = 1e6;

const optics::ReduceOptions kGrey{.colour_period_px = 1};

Stimulus White(double disk_deg) {
  Stimulus stimulus;
  stimulus.drive = DriveRgb{1, 1, 1};
  if (disk_deg > 0) stimulus.pattern = StimulusPattern::kDisk;
  stimulus.diameter_deg = disk_deg;
  return stimulus;
}

Setting SettingOf(const PilotOptions& options, size_t exposures) {
  Setting setting;
  setting.name = "pilot";
  setting.levels = EvenLevels(options.levels, std::vector<int>(exposures, options.frames));
  setting.model = options.model;
  setting.tier = FieldTier::kSmooth;
  setting.calibration_frames = options.calibration_frames;
  return setting;
}

double Median(const optics::MeasuredImage& image) {
  std::vector<float> values;
  for (size_t i = 0; i < image.mask.pixels().size(); ++i) {
    if (image.mask.pixels()[i] == 0) values.push_back(image.value.pixels()[i]);
  }
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

absl::Status DescribeCamera(const optics::Calibration& calibration, Pilot& pilot) {
  if (!calibration.flat || !calibration.flat->luminance) {
    return Rejected("pilot", "it has no flat of known luminance",
                    "record flats and state their luminance");
  }
  pilot.noise = calibration.noise;
  for (const double exposure_s : pilot.exposures_s) {
    EYEBOX_ASSIGN_OR_RETURN(const optics::DarkFrame* const dark,
                            optics::FindDark(calibration, {exposure_s, pilot.noise.gain_db}));
    pilot.dark_dn.push_back(std::max(Median(dark->image_dn) - pilot.noise.bias_dn, 0.0));
  }
  pilot.flat_luminance = calibration.flat->luminance->luminance_cd_m2;
  pilot.flat_relative_sigma = calibration.flat->luminance->relative_sigma;
  pilot.response = calibration.flat->response.value;
  for (float& value : pilot.response.pixels()) {
    value = static_cast<float>(value / pilot.flat_luminance);
  }
  double sum = 0;
  for (const size_t i : ReferenceDiskPixels(pilot.size)) {
    if (!std::isfinite(pilot.response.pixels()[i])) continue;
    sum += pilot.response.pixels()[i];
    ++pilot.reference_pixels;
  }
  if (pilot.reference_pixels == 0) {
    return Rejected("pilot", "no pixel at the image centre has a flat", "record the flats again");
  }
  pilot.response_at_reference = sum / static_cast<double>(pilot.reference_pixels);
  return absl::OkStatus();
}

absl::Status MeasureDisks(FrameSource& source, const Setting& setting, const PilotOptions& options,
                          const Clock& clock, Pilot& pilot) {
  for (const double diameter_deg : options.disks_deg) {
    Setting with_disk = setting;
    with_disk.disk_frames = options.disk_frames;
    EYEBOX_ASSIGN_OR_RETURN(
        const Measured measured,
        MeasureSetting(source, with_disk, {.disk_deg = diameter_deg}, {}, clock));
    pilot.disks.push_back({diameter_deg, measured.glare_factor});
  }
  return absl::OkStatus();
}

}  // namespace

PilotOptions PilotWithin(const Stock* limits) {
  PilotOptions options;
  if (limits == nullptr) return options;
  const auto levels = static_cast<int>(limits->drives.size());
  if ((levels - 1) % (options.levels - 1) != 0) options.levels = levels;
  options.frames = std::min(options.frames, limits->frames);
  options.calibration_frames = std::min(options.calibration_frames, limits->calibration_frames);
  options.disks_deg = limits->disks_deg;
  options.disk_frames = std::min(options.disk_frames, limits->disk_frames);
  return options;
}

absl::StatusOr<Pilot> MeasurePilot(FrameSource& source, const Clock& clock,
                                   const PilotOptions& options) {
  Pilot pilot;
  pilot.size = source.Size();
  pilot.geometry = source.Geometry();
  pilot.exposures_s = source.ExposuresS();
  pilot.frames = options.frames;
  pilot.calibration_frames = options.calibration_frames;
  pilot.saturation_dn = optics::SensorRange{.bits = source.Bits()}.SaturationDn();
  EYEBOX_ASSIGN_OR_RETURN(const auto* const calibration,
                          source.CalibrationOf(options.calibration_frames));
  EYEBOX_RETURN_IF_ERROR(DescribeCamera(*calibration, pilot));
  const Setting setting = SettingOf(options, pilot.exposures_s.size());
  EYEBOX_ASSIGN_OR_RETURN(Measured measured, MeasureSetting(source, setting, {}, {}, clock));
  pilot.activation = std::move(measured.fits[0]);
  if (options.primaries) {
    Setting coloured = setting;
    coloured.primaries = true;
    EYEBOX_ASSIGN_OR_RETURN(Measured colours, MeasureSetting(source, coloured, {}, {}, clock));
    pilot.primaries = std::move(colours.fits);
  }
  pilot.compute_s_per_mpx =
      measured.seconds.reduce /
      (FrameCount(setting) * static_cast<double>(pilot.size.PixelCount()) / kPixelsPerMpx);
  EYEBOX_ASSIGN_OR_RETURN(const auto stacks, source.Take(White(0), setting.levels.back().frames));
  EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel white,
                          optics::ReduceLevel(stacks, *calibration, kGrey));
  pilot.white = std::move(white.luminance.image);
  EYEBOX_ASSIGN_OR_RETURN(
      pilot.white_smooth,
      optics::FitSmoothField(pilot.white, optics::FieldModel::kPolynomial, kSmoothOrder));
  EYEBOX_RETURN_IF_ERROR(MeasureDisks(source, setting, options, clock, pilot));
  return pilot;
}

double GlareFactorOf(const Pilot& pilot, double diameter_deg) {
  if (pilot.disks.empty() || diameter_deg <= 0) return 1;
  const auto above = std::ranges::find_if(
      pilot.disks, [&](const DiskFactor& disk) { return disk.diameter_deg >= diameter_deg; });
  if (above == pilot.disks.begin()) return pilot.disks.front().factor;
  if (above == pilot.disks.end()) return pilot.disks.back().factor;
  const DiskFactor& below = *std::prev(above);
  const double t = std::log(diameter_deg / below.diameter_deg) /
                   std::log(above->diameter_deg / below.diameter_deg);
  return below.factor + t * (above->factor - below.factor);
}

}  // namespace eyebox::service
