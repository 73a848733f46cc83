#include "capture/recording/import.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "capture/base/image_file.h"
#include "capture/base/status.h"
#include "capture/base/version.h"
#include "capture/recording/import_index.h"
#include "capture/recording/staging.h"
#include "capture/recording/writer.h"

namespace eyebox::capture {
namespace {

struct ImportedCapture {
  CaptureSpec spec;
  std::vector<const IndexedFrame*> frames;  // by repeat
};

absl::Status CheckRepeats(const ImportedCapture& capture) {
  for (size_t i = 1; i < capture.frames.size(); ++i) {
    if (capture.frames[i - 1]->repeat != capture.frames[i]->repeat) continue;
    return BadInput(capture.frames[i]->where,
                    "gives repeat " + std::to_string(capture.frames[i]->repeat) +
                        " of the same capture as " + capture.frames[i - 1]->where,
                    "count repeats up, or tell the captures apart by series or stimulus");
  }
  return absl::OkStatus();
}

absl::StatusOr<std::vector<ImportedCapture>> Group(const std::vector<IndexedFrame>& frames) {
  std::vector<ImportedCapture> captures;
  for (const IndexedFrame& frame : frames) {
    auto found = std::ranges::find(captures, frame.spec, &ImportedCapture::spec);
    if (found == captures.end()) found = captures.insert(found, {frame.spec, {}});
    found->frames.push_back(&frame);
  }
  for (ImportedCapture& capture : captures) {
    std::ranges::stable_sort(capture.frames, {}, &IndexedFrame::repeat);
    EYEBOX_RETURN_IF_ERROR(CheckRepeats(capture));
    capture.spec.repeats = static_cast<int>(capture.frames.size());
  }
  return captures;
}

// What all frames must have in common: taken from the first.
struct Sensor {
  ImageSize size;
  int bits = 0;
};

int BitsOf(const IndexedFrame& frame, const StillImage& image) {
  return frame.bits.value_or(image.bits_per_sample);
}

absl::Status CheckImage(const IndexedFrame& frame, const StillImage& image, const Sensor& sensor) {
  const std::string file = frame.file.string();
  const ImageSize size = image.pixels_dn.size();
  if (size != sensor.size) {
    return BadInput(file,
                    "is " + std::to_string(size.width_px) + " x " + std::to_string(size.height_px) +
                        " px, the first frame of index.csv is " +
                        std::to_string(sensor.size.width_px) + " x " +
                        std::to_string(sensor.size.height_px) + " px",
                    "import frames of one size at a time");
  }
  if (BitsOf(frame, image) != sensor.bits) {
    return BadInput(file,
                    "has " + std::to_string(BitsOf(frame, image)) +
                        " significant bits, the first frame of index.csv has " +
                        std::to_string(sensor.bits),
                    "import frames of one depth at a time");
  }
  const uint16_t largest_dn = std::ranges::max(image.pixels_dn.pixels());
  if (largest_dn < 1 << sensor.bits) return absl::OkStatus();
  return BadInput(file,
                  "holds a count of " + std::to_string(largest_dn) + " DN, more than " +
                      std::to_string(sensor.bits) + " bits give",
                  "state the right bits, or shift the counts down if they are aligned to the left");
}

absl::StatusOr<Sensor> ReadSensor(const IndexedFrame& first) {
  EYEBOX_ASSIGN_OR_RETURN(const StillImage image, ReadGreyImage(first.file));
  return Sensor{.size = image.pixels_dn.size(), .bits = BitsOf(first, image)};
}

RecordingHeader MakeHeader(const std::vector<ImportedCapture>& captures, const Sensor& sensor,
                           const Clock& clock) {
  RecordingHeader header;
  header.origin = RecordingOrigin::kImported;
  header.rig = {.name = "imported", .camera_uri = "import:index.csv", .seed = 0};
  for (const ImportedCapture& capture : captures) header.plan.captures.push_back(capture.spec);
  const auto [shortest, longest] =
      std::ranges::minmax(header.plan.captures, {}, &CaptureSpec::exposure_s);
  const auto [lowest, highest] =
      std::ranges::minmax(header.plan.captures, {}, &CaptureSpec::gain_db);
  header.camera.uri = header.rig.camera_uri;
  header.camera.sensor_size = sensor.size;
  header.camera.significant_bits = sensor.bits;
  header.camera.exposure_min_s = shortest.exposure_s;
  header.camera.exposure_max_s = longest.exposure_s;
  header.camera.gain_min_db = lowest.gain_db;
  header.camera.gain_max_db = highest.gain_db;
  header.software_version = std::string(kVersion);
  header.created_real_ns = clock.RealNs();
  return header;
}

Frame MakeFrame(const IndexedFrame& indexed, const StillImage& image, uint64_t id) {
  Frame frame;
  frame.metadata.camera_frame_id = id;
  frame.metadata.device_time_ns = indexed.device_time_ns;
  frame.metadata.exposure_asked_s = indexed.spec.exposure_s;
  frame.metadata.gain_asked_db = indexed.spec.gain_db;
  frame.metadata.photodiode_counts = indexed.photodiode_counts;
  frame.view = {.pixels_dn = image.pixels_dn.pixels(), .size = image.pixels_dn.size()};
  return frame;
}

class Importer {
 public:
  Importer(RecordingWriter& writer, const Sensor& sensor, int64_t frames_total,
           const ImportProgress& progress)
      : writer_(writer), sensor_(sensor), frames_total_(frames_total), progress_(progress) {}

  absl::Status Import(const ImportedCapture& capture) {
    EYEBOX_ASSIGN_OR_RETURN(const auto written, writer_.BeginCapture(capture.spec, sensor_.size));
    for (const IndexedFrame* indexed : capture.frames) {
      EYEBOX_ASSIGN_OR_RETURN(const StillImage image, ReadGreyImage(indexed->file));
      EYEBOX_RETURN_IF_ERROR(CheckImage(*indexed, image, sensor_));
      const auto id = static_cast<uint64_t>(++report_.frames);
      EYEBOX_RETURN_IF_ERROR(written->Append(MakeFrame(*indexed, image, id)));
      if (progress_) progress_(report_.frames, frames_total_);
    }
    EYEBOX_RETURN_IF_ERROR(written->Acknowledge());
    EYEBOX_RETURN_IF_ERROR(written->Publish());
    ++report_.captures;
    if (capture.spec.kind == FrameKind::kLight &&
        std::ranges::find(report_.series, capture.spec.series) == report_.series.end()) {
      report_.series.push_back(capture.spec.series);
    }
    return absl::OkStatus();
  }

  const ImportReport& report() const { return report_; }

 private:
  RecordingWriter& writer_;
  const Sensor sensor_;
  const int64_t frames_total_;
  const ImportProgress& progress_;
  ImportReport report_;
};

}  // namespace

absl::StatusOr<ImportReport> ImportFolder(const std::filesystem::path& folder,
                                          const std::filesystem::path& recording,
                                          const Clock* clock, const ImportProgress& progress) {
  EYEBOX_RETURN_IF_ERROR(CheckVacant(recording));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<IndexedFrame> frames, ReadImportIndex(folder));
  EYEBOX_ASSIGN_OR_RETURN(const std::vector<ImportedCapture> captures, Group(frames));
  EYEBOX_ASSIGN_OR_RETURN(const Sensor sensor, ReadSensor(frames.front()));
  EYEBOX_ASSIGN_OR_RETURN(StagedFolder staged, StagedFolder::Begin(recording));
  EYEBOX_ASSIGN_OR_RETURN(
      const auto writer,
      RecordingWriter::Create(staged.path(), MakeHeader(captures, sensor, *clock), clock));
  Importer importer(*writer, sensor, static_cast<int64_t>(frames.size()), progress);
  for (const ImportedCapture& capture : captures) {
    EYEBOX_RETURN_IF_ERROR(importer.Import(capture));
  }
  EYEBOX_RETURN_IF_ERROR(staged.Commit());
  return importer.report();
}

}  // namespace eyebox::capture
