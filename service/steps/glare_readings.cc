#include "service/steps/glare_readings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "capture/base/status.h"
#include "capture/plan.h"
#include "optics/scatter/remove_glare.h"
#include "service/steps/captures.h"
#include "service/steps/drift.h"
#include "service/steps/levels.h"

namespace eyebox::service {
namespace {

constexpr double kSameDrive = 1e-6;

// Diameter on the image plane of a disk that the eye sees at `diameter_deg`.
double OnPlane(double diameter_deg) {
  const double half = diameter_deg / 2 * std::numbers::pi / 180;
  return 2 * std::tan(half) * 180 / std::numbers::pi;
}

// Side on the image plane of a square that touches the axis and is seen at `side_deg`.
double SideOnPlane(double side_deg) {
  return std::tan(side_deg * std::numbers::pi / 180) * 180 / std::numbers::pi;
}

double DriveOf(const Stimulus& stimulus) {
  return stimulus.drive ? *std::max_element(stimulus.drive->begin(), stimulus.drive->end()) : -1;
}

absl::StatusOr<std::string> GlareSeriesOf(const capture::RecordingReader& recording,
                                          const std::optional<std::string>& asked) {
  if (asked) return *asked;
  std::set<std::string> names;
  for (const auto* entry : CapturesOfKind(recording, FrameKind::kLight)) {
    if (entry->spec.stimulus.pattern != StimulusPattern::kFullField) {
      names.insert(entry->spec.series);
    }
  }
  if (names.contains(capture::kGlareSeries)) return capture::kGlareSeries;
  if (names.size() == 1) return *names.begin();
  if (names.empty()) {
    return Rejected("glare series", "the recording shows no disk and no checkerboard",
                    "record bright disks of several diameters, black disks and full fields "
                    "(eyebox capture or simulate with --disks, --black-disks, --checkerboards)");
  }
  return Missing("glare series", "several series show disks or checkerboards",
                 "choose one with --series: " + absl::StrJoin(names, ", "));
}

absl::Status AddReadings(const Stimulus& stimulus, const optics::MeasuredImage& image,
                         const optics::Calibration& calibration, const GlareOptions& options,
                         double drift_relative_sigma, MeasuredGlare& glare) {
  const bool field = stimulus.pattern == StimulusPattern::kFullField;
  const bool lit = DriveOf(stimulus) > kSameDrive;
  const bool bright_disk = stimulus.pattern == StimulusPattern::kDisk || (field && !lit);
  EYEBOX_ASSIGN_OR_RETURN(
      auto readings,
      fit::ReadDisk(image, calibration, glare.aim,
                    bright_disk ? fit::GlarePattern::kBrightDisk : fit::GlarePattern::kBlackDisk,
                    field ? 0 : OnPlane(stimulus.diameter_deg), options.reading));
  for (fit::GlareReading& reading : readings) {
    reading.luminance_sigma =
        std::hypot(reading.luminance_sigma, drift_relative_sigma * reading.luminance);
  }
  glare.series.readings.insert(glare.series.readings.end(), readings.begin(), readings.end());
  return absl::OkStatus();
}

// Leaves the brightest drive and black; says how many stimuli that costs.
void KeepBrightest(std::vector<StimulusCaptures>& groups, MeasuredGlare& glare) {
  double brightest = 0;
  for (const StimulusCaptures& group : groups) {
    if (group.stimulus.pattern == StimulusPattern::kFullField) continue;
    brightest = std::max(brightest, DriveOf(group.stimulus));
  }
  const size_t left_out = std::erase_if(groups, [&](const StimulusCaptures& group) {
    const double drive = DriveOf(group.stimulus);
    const bool black =
        group.stimulus.pattern == StimulusPattern::kFullField && std::abs(drive) < kSameDrive;
    return !black && std::abs(drive - brightest) > kSameDrive;
  });
  if (left_out == 0) return;
  glare.warnings.push_back(
      absl::StrFormat("%d stimuli of another drive than %.4g were left out", left_out, brightest));
}

absl::StatusOr<CheckerboardFigure> MeasureBoard(
    const optics::LuminanceImage& image, double square_deg, const MeasuredGlare& glare,
    const std::optional<optics::KnownGlare>& instrument) {
  CheckerboardFigure figure{square_deg, {}, {}};
  EYEBOX_ASSIGN_OR_RETURN(
      const optics::Checkerboard board,
      optics::CheckerboardAround(image.image.size(), glare.aim.axis,
                                 SideOnPlane(square_deg) / glare.aim.pitch_deg));
  std::optional<optics::InstrumentGlare> seen_through;
  if (instrument) seen_through = {instrument->kernel, glare.aim.pitch_deg};
  EYEBOX_ASSIGN_OR_RETURN(figure.seen, optics::CheckerboardContrast(image, board, seen_through));
  if (!instrument) return figure;
  EYEBOX_ASSIGN_OR_RETURN(const optics::GlareRemoval removal,
                          optics::RemoveGlare(image, *instrument));
  EYEBOX_ASSIGN_OR_RETURN(figure.corrected,
                          optics::CheckerboardContrast(removal.luminance, board, std::nullopt));
  return figure;
}

struct SeenSpot {
  double diameter_deg = 0;  // on the plane
  optics::LuminanceImage image;
  double drift_relative_sigma = 0;
};

struct SeenStimuli {
  std::optional<optics::LuminanceImage> black;
  std::vector<SeenSpot> spots;
  double bright_drift_relative_sigma = 0;  // the black field's is nothing beside its noise
};

void Keep(const Stimulus& stimulus, optics::LuminanceImage image, double drift_relative_sigma,
          SeenStimuli& seen, MeasuredGlare& glare) {
  if (stimulus.pattern == StimulusPattern::kBlackDisk) {
    seen.spots.push_back({OnPlane(stimulus.diameter_deg), std::move(image), drift_relative_sigma});
  } else if (stimulus.pattern == StimulusPattern::kFullField && DriveOf(stimulus) > kSameDrive) {
    glare.bright_field = std::move(image);
    seen.bright_drift_relative_sigma = drift_relative_sigma;
  } else if (stimulus.pattern == StimulusPattern::kFullField) {
    seen.black = std::move(image);
  }
}

absl::Status AddFigures(const SeenStimuli& seen, const GlareOptions& options,
                        const std::optional<optics::KnownGlare>& instrument, MeasuredGlare& glare) {
  if (!glare.bright_field) return absl::OkStatus();
  const optics::MeasuringDisk disk{glare.aim.axis, options.reading.spot_radius_px};
  if (seen.black) {
    EYEBOX_ASSIGN_OR_RETURN(glare.full_field_contrast,
                            optics::FullFieldContrast(*glare.bright_field, *seen.black, disk));
    optics::ContrastFigure& figure = *glare.full_field_contrast;
    figure.sigma = std::hypot(figure.sigma, seen.bright_drift_relative_sigma * figure.contrast);
  }
  const auto kernel = instrument ? std::optional(instrument->kernel) : std::nullopt;
  for (const auto& [diameter_deg, image, drift_relative_sigma] : seen.spots) {
    const optics::BlackSpot spot{disk, diameter_deg, options.field_radius_deg};
    EYEBOX_ASSIGN_OR_RETURN(optics::GlareFigure figure,
                            optics::BlackSpotGlare(image, *glare.bright_field, spot, kernel));
    figure.sigma = std::hypot(figure.sigma, figure.share * drift_relative_sigma,
                              figure.share * seen.bright_drift_relative_sigma);
    glare.black_spots.push_back({diameter_deg, figure});
  }
  return absl::OkStatus();
}

absl::StatusOr<fit::DiskAim> AimOf(const capture::RecordingHeader& header) {
  EYEBOX_ASSIGN_OR_RETURN(const double pitch_deg, PitchDeg(header));
  return fit::DiskAim{{header.geometry->principal_x_px, header.geometry->principal_y_px},
                      pitch_deg};
}

}  // namespace

absl::Status GlareOptions::Validate() const {
  EYEBOX_RETURN_IF_ERROR(reading.Validate());
  if (field_radius_deg > 0 && std::isfinite(field_radius_deg)) return absl::OkStatus();
  return BadInput("field_radius_deg", absl::StrCat("is ", field_radius_deg),
                  "give the radius of the display's field, above 0");
}

absl::StatusOr<double> PitchDeg(const capture::RecordingHeader& header) {
  if (header.geometry && header.geometry->focal_length_px > 0) {
    return 180 / std::numbers::pi / header.geometry->focal_length_px;
  }
  return Rejected("recording.textproto", "has no geometry, so that pixels have no field angle",
                  "state the focal length and the principal point of the camera");
}

absl::StatusOr<MeasuredGlare> MeasureGlare(capture::RecordingReader& recording,
                                           const std::optional<std::string>& series,
                                           const optics::Calibration& calibration,
                                           const GlareOptions& options,
                                           const std::optional<optics::KnownGlare>& instrument,
                                           const Watcher& watcher) {
  EYEBOX_RETURN_IF_ERROR(options.Validate());
  EYEBOX_ASSIGN_OR_RETURN(const std::string name, GlareSeriesOf(recording, series));
  EYEBOX_ASSIGN_OR_RETURN(auto groups, LightCaptures(recording, name));
  MeasuredGlare glare;
  EYEBOX_ASSIGN_OR_RETURN(glare.aim, AimOf(recording.Header()));
  glare.series.field_radius_deg = options.field_radius_deg;
  glare.series.source = absl::StrCat("series \"", name, "\"");
  KeepBrightest(groups, glare);
  std::optional<optics::KnownGlare> camera = instrument;
  if (camera) {
    camera->pitch_deg = glare.aim.pitch_deg;
    camera->surround = options.surround;
  }
  SeenStimuli seen;
  EYEBOX_ASSIGN_OR_RETURN(const MeasuredDrift drift, MeasureDrift(recording));
  glare.warnings.insert(glare.warnings.end(), drift.warnings.begin(), drift.warnings.end());
  bool beyond = false;
  for (size_t i = 0; i < groups.size(); ++i) {
    EYEBOX_RETURN_IF_ERROR(
        watcher.Reach(static_cast<double>(i) / static_cast<double>(groups.size()),
                      absl::StrFormat("glare of %d stimuli", groups.size())));
    const Stimulus& stimulus = groups[i].stimulus;
    EYEBOX_ASSIGN_OR_RETURN(optics::ReducedLevel level,
                            ReduceCaptures(recording, groups[i], calibration));
    EYEBOX_ASSIGN_OR_RETURN(
        const auto drift_sigma,
        CorrectForDriftWithin(recording, groups[i].captures, drift.drift, level.luminance));
    beyond = beyond || !drift_sigma;
    glare.series.luminance_unit = level.luminance.image.unit;
    if (stimulus.pattern == StimulusPattern::kCheckerboard) {
      EYEBOX_ASSIGN_OR_RETURN(glare.checkerboards.emplace_back(),
                              MeasureBoard(level.luminance, stimulus.diameter_deg, glare, camera));
      continue;
    }
    EYEBOX_RETURN_IF_ERROR(AddReadings(stimulus, level.luminance.image, calibration, options,
                                       drift_sigma.value_or(0), glare));
    Keep(stimulus, std::move(level.luminance), drift_sigma.value_or(0), seen, glare);
  }
  if (beyond) {
    glare.warnings.emplace_back(
        "some stimuli were shown before or after all readings of the drift, and are not corrected "
        "for it");
  }
  EYEBOX_RETURN_IF_ERROR(AddFigures(seen, options, camera, glare));
  return glare;
}

}  // namespace eyebox::service
