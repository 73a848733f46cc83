#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "capture/base/status.h"
#include "service/planner/recording_measurement.h"
#include "service/steps/captures.h"
#include "service/steps/known_geometry.h"

namespace eyebox::service {
namespace {

using capture::CaptureEntry;

bool IsWhite(const DriveRgb& drive) { return drive == DriveRgb{1, 1, 1}; }

bool IsGrey(const DriveRgb& drive) { return drive[0] == drive[1] && drive[1] == drive[2]; }

bool IsGreyField(const CaptureSpec& spec) {
  return spec.kind == FrameKind::kLight && spec.stimulus.drive && IsGrey(*spec.stimulus.drive) &&
         spec.stimulus.pattern == StimulusPattern::kFullField;
}

// References are shown between the levels, a drifting display's at other luminances.
bool IsOfUse(const CaptureEntry& entry) {
  if (!entry.suspect.empty() || entry.frame_count == 0) return false;
  if (entry.spec.role == CaptureRole::kReference) return false;
  return entry.spec.kind != FrameKind::kLight || entry.spec.stimulus.drive.has_value();
}

absl::StatusOr<PinholeGeometry> GeometryOf(const capture::RecordingReader& reader,
                                           const std::filesystem::path& recording) {
  if (reader.Header().geometry) return *reader.Header().geometry;
  EYEBOX_ASSIGN_OR_RETURN(const auto known, KnownGeometry(recording, {}));
  if (known) {
    return PinholeGeometry{known->camera.focal_length_x_px, known->camera.principal_x_px,
                           known->camera.principal_y_px};
  }
  return Rejected(recording.string(), "nothing tells its field angles",
                  "calibrate the camera (eyebox geometry) and record with --geometry");
}

absl::Status CheckCamera(const capture::RecordingReader& reader,
                         const std::filesystem::path& recording) {
  if (ColourPeriodPx(reader.Header()) != 1) {
    return BadInput(recording.string(), "its camera has a colour mosaic",
                    "use a recording of a grey camera");
  }
  size_t bytes = 0;
  for (const CaptureEntry& entry : reader.Captures()) {
    if (!IsOfUse(entry)) continue;
    bytes += entry.frame_size.PixelCount() * sizeof(uint16_t) * entry.frame_count;
  }
  if (bytes <= RecordedFrames::kMostBytes) return absl::OkStatus();
  return BadInput(recording.string(),
                  absl::StrFormat("its frames are %.1f GB, and all of them are held in memory",
                                  static_cast<double>(bytes) / 1e9),
                  absl::StrFormat("record a smaller region or fewer repeats, %.1f GB at most",
                                  static_cast<double>(RecordedFrames::kMostBytes) / 1e9));
}

// Exposures that every grey level was taken in.
std::vector<double> CommonExposures(const capture::RecordingReader& reader,
                                    const std::vector<double>& drives) {
  std::map<double, std::set<double>> drives_by_exposure;
  for (const CaptureEntry& entry : reader.Captures()) {
    if (!IsOfUse(entry) || !IsGreyField(entry.spec)) continue;
    drives_by_exposure[entry.spec.exposure_s].insert((*entry.spec.stimulus.drive)[0]);
  }
  std::vector<double> exposures_s;
  for (const auto& [exposure_s, of_exposure] : drives_by_exposure) {
    if (of_exposure.size() == drives.size()) exposures_s.push_back(exposure_s);
  }
  return exposures_s;
}

}  // namespace

absl::Status RecordedFrames::Survey(const capture::RecordingReader& reader) {
  std::set<double> gains, grey, disks, flats, sigmas;
  for (const CaptureEntry& entry : reader.Captures()) {
    if (!IsOfUse(entry)) continue;
    const CaptureSpec& spec = entry.spec;
    size = entry.frame_size;
    gains.insert(spec.gain_db);
    if (IsGreyField(spec)) grey.insert((*spec.stimulus.drive)[0]);
    if (spec.kind == FrameKind::kLight && spec.stimulus.pattern == StimulusPattern::kDisk &&
        IsWhite(*spec.stimulus.drive)) {
      disks.insert(spec.stimulus.diameter_deg);
    }
    if (spec.kind == FrameKind::kFlat) {
      flats.insert(spec.luminance_cd_m2.value_or(0));
      sigmas.insert(spec.luminance_relative_sigma.value_or(0));
    }
  }
  if (gains.size() > 1) return BadInput(name, "it holds several gains", "record with one gain");
  if (grey.empty() || *grey.rbegin() != 1) {
    return Rejected(name, "it has no grey full fields up to drive 1", "record grey levels");
  }
  if (flats.size() != 1 || !(*flats.begin() > 0)) {
    return Rejected(name, "it has no flats of one known luminance",
                    "record flats and state their luminance");
  }
  gain_db = *gains.begin();
  drives.assign(grey.begin(), grey.end());
  disks_deg.assign(disks.begin(), disks.end());
  flat_luminance_cd_m2 = *flats.begin();
  flat_relative_sigma = *sigmas.rbegin();
  exposures_s = CommonExposures(reader, drives);
  if (!exposures_s.empty()) return absl::OkStatus();
  return Rejected(name, "no exposure was taken of every grey level",
                  "record each level with the same exposures");
}

absl::Status RecordedFrames::Load(capture::RecordingReader& reader) {
  for (const CaptureEntry& entry : reader.Captures()) {
    if (!IsOfUse(entry)) continue;
    const auto exposure = std::ranges::find(exposures_s, entry.spec.exposure_s);
    if (exposure == exposures_s.end()) continue;
    if (entry.frame_size != size) {
      return BadInput(name, absl::StrCat("capture ", entry.number, " is of another size"),
                      "record with one region of interest");
    }
    Frames& frames =
        frames_[{SceneKeyOf(entry.spec), static_cast<size_t>(exposure - exposures_s.begin())}];
    EYEBOX_RETURN_IF_ERROR(reader.VisitFrames(entry, [&](const Frame& frame) {
      frames.emplace_back(frame.view.pixels_dn.begin(), frame.view.pixels_dn.end());
      return absl::OkStatus();
    }));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::shared_ptr<const RecordedFrames>> RecordedFrames::Read(
    const std::filesystem::path& recording) {
  EYEBOX_ASSIGN_OR_RETURN(const auto reader, capture::RecordingReader::Open(recording));
  EYEBOX_RETURN_IF_ERROR(CheckCamera(*reader, recording));
  auto frames = std::make_shared<RecordedFrames>();
  frames->name = recording.string();
  frames->bits = reader->Header().camera.significant_bits;
  EYEBOX_ASSIGN_OR_RETURN(frames->geometry, GeometryOf(*reader, recording));
  EYEBOX_RETURN_IF_ERROR(frames->Survey(*reader));
  EYEBOX_RETURN_IF_ERROR(frames->Load(*reader));
  return frames;
}

const RecordedFrames::Frames& RecordedFrames::Of(const CaptureSpec& scene, size_t exposure) const {
  static const Frames kNone;
  const auto found = frames_.find({SceneKeyOf(scene), exposure});
  return found == frames_.end() ? kNone : found->second;
}

}  // namespace eyebox::service
