// Small recordings for tests: every pixel and every field is a function of its place.
#ifndef EYEBOX_TESTS_CAPTURE_RECORDING_RECORDED_H_
#define EYEBOX_TESTS_CAPTURE_RECORDING_RECORDED_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/recording/reader.h"
#include "capture/recording/writer.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {

constexpr ImageSize kFrameSize = {.width_px = 7, .height_px = 5};

inline Frame FrameOf(int number, ImageSize size = kFrameSize) {
  auto counts_dn = std::make_shared<std::vector<uint16_t>>(size.PixelCount());
  for (size_t i = 0; i < counts_dn->size(); ++i) {
    (*counts_dn)[i] = static_cast<uint16_t>(1000 * number + 37 * static_cast<int>(i));
  }
  Frame frame;
  frame.metadata.camera_frame_id = static_cast<uint64_t>(100 + number);
  frame.metadata.monotonic_time_ns = 5'000'000'000 + number;
  frame.metadata.exposure_asked_s = 0.0125;
  frame.view = {.pixels_dn = *counts_dn, .size = size};
  frame.owner = std::move(counts_dn);
  return frame;
}

inline CaptureSpec SpecOf(int repeats, double drive = 0.25) {
  CaptureSpec spec;
  spec.series = "grey";
  spec.level_id = 3;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  spec.exposure_s = 0.0125;
  spec.repeats = repeats;
  return spec;
}

inline RecordingHeader HeaderOf() {
  RecordingHeader header;
  header.origin = RecordingOrigin::kSimulated;
  header.rig = {.name = "bench-1", .camera_uri = "sim:rift-s-like", .seed = 18446744073709551615U};
  header.camera = {.uri = "sim:rift-s-like",
                   .vendor = "Eyebox",
                   .model = "simulator",
                   .serial = "7",
                   .sensor_size = kFrameSize,
                   .significant_bits = 12,
                   .exposure_min_s = 1e-5,
                   .exposure_max_s = 10,
                   .gain_min_db = 0,
                   .gain_max_db = 24,
                   .pixel_format = "Mono12p",
                   .black_level_min = -8,
                   .black_level_max = 255.5,
                   .software_trigger = false,
                   .trigger_lines = {"Line0", "Line2"},
                   .free_run = true};
  header.geometry = PinholeGeometry{219.8, 3.0000000000000004, 2};
  header.plan.captures = {SpecOf(2), SpecOf(3, 0.1)};
  header.software_version = "0.1.0";
  header.created_real_ns = 1700000000123456789;
  header.camera_settings = CameraSettings{
      .trigger = TriggerSource::kLine, .trigger_line = "Line2", .black_level = 16.25};
  return header;
}

// Two captures: frames 0 and 1, then 2, 3 and 4.
inline void Record(const std::filesystem::path& recording) {
  const RecordingHeader header = HeaderOf();
  auto writer = RecordingWriter::Create(recording, header, SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  int number = 0;
  for (const CaptureSpec& spec : header.plan.captures) {
    auto capture = (*writer)->BeginCapture(spec, kFrameSize);
    ASSERT_TRUE(capture.ok()) << capture.status();
    for (int i = 0; i < spec.repeats; ++i) ASSERT_TRUE((*capture)->Append(FrameOf(number++)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    const absl::Status published = (*capture)->Publish();
    ASSERT_TRUE(published.ok()) << published;
  }
}

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_CAPTURE_RECORDING_RECORDED_H_
