// Frames of a rich recording, some of them measured with and the others taken for the truth.
#ifndef EYEBOX_SERVICE_PLANNER_RECORDING_MEASUREMENT_H_
#define EYEBOX_SERVICE_PLANNER_RECORDING_MEASUREMENT_H_

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "capture/recording/reader.h"
#include "service/planner/held_frames.h"

namespace eyebox::service {

// All that is of use in a recording, in memory: shared by any number of measurements.
class RecordedFrames {
 public:
  // Exposures are those in which every grey level was taken. Errors: those of reading;
  // InvalidArgument (a colour mosaic, several gains, or more frames than kMostBytes);
  // FailedPrecondition (no darks, no flats of one known luminance, no grey levels up to white, no
  // geometry: says what to record).
  static absl::StatusOr<std::shared_ptr<const RecordedFrames>> Read(
      const std::filesystem::path& recording);
  static constexpr size_t kMostBytes = size_t{4} << 30;

  using Frames = std::vector<std::vector<uint16_t>>;
  // In the order in which they were taken; empty where there are none.
  const Frames& Of(const CaptureSpec& scene, size_t exposure) const;

  std::string name;
  ImageSize size;
  int bits = 0;
  double gain_db = 0;
  PinholeGeometry geometry;
  std::vector<double> exposures_s;  // ascending
  double flat_luminance_cd_m2 = 0;
  double flat_relative_sigma = 0;
  std::vector<double> drives;     // of grey full fields, ascending, the last 1
  std::vector<double> disks_deg;  // white on black, ascending

 private:
  absl::Status Survey(const capture::RecordingReader& reader);
  absl::Status Load(capture::RecordingReader& reader);

  std::map<std::pair<std::vector<uint64_t>, size_t>, Frames> frames_;
};

class RecordingMeasurement final : public HeldFrames {
 public:
  // Every frame is at hand, and no truth.
  explicit RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames);
  // Another half of the frames for each seed; the truth is what the other half tells.
  RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames, uint64_t seed);

  ImageSize Size() const override { return frames_->size; }
  int Bits() const override { return frames_->bits; }
  const PinholeGeometry& Geometry() const override { return frames_->geometry; }
  const std::vector<double>& ExposuresS() const override { return frames_->exposures_s; }
  const Stock* Limits() const override { return &stock_; }
  // Errors: Unimplemented (every frame is at hand); those of MeasureSetting.
  absl::StatusOr<Truth> TruthFor(double disk_deg) override;

 private:
  enum class Share { kAll, kFirstHalf, kSecondHalf };

  RecordingMeasurement(std::shared_ptr<const RecordedFrames> frames, uint64_t seed, Share share);
  absl::StatusOr<std::vector<Counts>> FramesOf(const CaptureSpec& scene, size_t exposure,
                                               int count) override;
  CaptureSpec FlatScene() const override;
  optics::KnownLuminance StatedFlat() const override;
  double GainDb() const override { return frames_->gain_db; }
  std::vector<size_t> OrderOf(const CaptureSpec& scene, size_t exposure) const;
  int CountOf(const CaptureSpec& scene) const;  // of every exposure

  std::shared_ptr<const RecordedFrames> frames_;
  uint64_t seed_;
  Share share_;
  Stock stock_;
  std::map<double, Truth> truths_;  // by disk
};

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_PLANNER_RECORDING_MEASUREMENT_H_
