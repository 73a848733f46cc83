// Recordings of 4 x 2 pixels, written in a moment.
#ifndef EYEBOX_TESTS_SERVICE_SERVER_SMALL_RECORDING_H_
#define EYEBOX_TESTS_SERVICE_SERVER_SMALL_RECORDING_H_

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "capture/recording/writer.h"

namespace eyebox::service {

struct SmallRecording {
  std::string rig = "lab";
  std::string camera = "sim:small";
  int64_t start_ns = 1'000'000'000;
  std::vector<std::string> series = {"", "blue"};  // one capture each, of one grey level
  int planned = 2;                                 // the first so many of the series
  int taken = 2;                                   // the first so many are captured
  int repeats = 3;
};

constexpr ImageSize kSmallSize = {.width_px = 4, .height_px = 2};

inline CaptureSpec SmallSpec(const SmallRecording& what, int capture) {
  CaptureSpec spec;
  spec.series = what.series.at(static_cast<size_t>(capture));
  spec.level_id = capture;
  const double grey = 0.25 * (capture + 1);
  spec.stimulus.drive = DriveRgb{grey, grey, grey};
  spec.exposure_s = 0.01;
  spec.repeats = what.repeats;
  return spec;
}

inline void TakeSmall(const SmallRecording& what, int capture, capture::RecordingWriter& writer) {
  static const std::vector<uint16_t> counts_dn(kSmallSize.PixelCount(), 7);
  auto taking = writer.BeginCapture(SmallSpec(what, capture), kSmallSize);
  ASSERT_TRUE(taking.ok()) << taking.status();
  for (int i = 0; i < what.repeats; ++i) {
    Frame frame;
    frame.metadata.camera_frame_id = static_cast<uint64_t>(i);
    frame.metadata.monotonic_time_ns = i;
    frame.metadata.exposure_asked_s = 0.01;
    frame.view = {.pixels_dn = counts_dn, .size = kSmallSize};
    ASSERT_TRUE((*taking)->Append(frame).ok());
  }
  ASSERT_TRUE((*taking)->Acknowledge().ok());
  ASSERT_TRUE((*taking)->Publish().ok());
}

// Written whole before it returns; `keep` gets the writer, to go on with.
inline void WriteSmall(const std::filesystem::path& folder, const SmallRecording& what,
                       std::unique_ptr<capture::RecordingWriter>* keep = nullptr) {
  capture::RecordingHeader header;
  header.rig = {.name = what.rig, .camera_uri = what.camera};
  header.camera.uri = what.camera;
  header.camera.sensor_size = kSmallSize;
  header.camera.significant_bits = 12;
  header.software_version = "test";
  header.created_real_ns = what.start_ns;
  for (int i = 0; i < what.planned; ++i) header.plan.captures.push_back(SmallSpec(what, i));
  std::filesystem::create_directories(folder.parent_path());
  auto writer = capture::RecordingWriter::Create(folder, header, SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  for (int i = 0; i < what.taken; ++i) TakeSmall(what, i, **writer);
  if (keep) *keep = *std::move(writer);
}

// When the file was touched last, as the kernel's clock has it, which advances in steps.
inline std::pair<time_t, long> ChangeTimeOf(const std::filesystem::path& file) {
  struct stat status = {};
  EXPECT_EQ(stat(file.c_str(), &status), 0);
  return {status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
}

// One byte of a file changes in place, later than whatever was done to the file before.
inline void FlipByte(const std::filesystem::path& file, std::streamoff at) {
  const auto before = ChangeTimeOf(file);
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(at);
  const int byte = stream.get();
  do {
    stream.seekp(at);
    stream.put(static_cast<char>(byte ^ 1));
    stream.flush();
    ASSERT_TRUE(stream.good());
  } while (ChangeTimeOf(file) == before);
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_SERVER_SMALL_RECORDING_H_
