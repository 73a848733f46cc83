// What every camera must do. The tests stand in camera_contract.cc; a program that links it names
// its cameras with INSTANTIATE_TEST_SUITE_P(..., CameraContract, ...).
#ifndef EYEBOX_TESTS_CONTRACT_CAMERA_CONTRACT_H_
#define EYEBOX_TESTS_CONTRACT_CAMERA_CONTRACT_H_

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include "capture/base/clock.h"
#include "capture/camera/rig.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {

inline constexpr int kRepeats = 4;

inline CaptureSpec Grey(double drive, double exposure_s) {
  CaptureSpec spec;
  spec.stimulus.drive = DriveRgb{drive, drive, drive};
  spec.exposure_s = exposure_s;
  spec.repeats = kRepeats;
  return spec;
}

inline const CaptureSpec kBright = Grey(0.6, 0.0125);
inline const CaptureSpec kLong = Grey(0.6, 0.025);

// How to come by a rig whose presenter knows kBright and kLong.
struct CameraCase {
  const char* name;
  std::string (*uri)(const std::filesystem::path& folder);
  bool linear = true;           // counts are proportional to the exposure
  bool queues_triggers = true;  // those that come before the frame of the one before
  std::chrono::milliseconds timeout{1000};
};

class CameraContract : public testing::TestWithParam<CameraCase> {
 protected:
  void SetUp() override {
    uri_ = GetParam().uri(folder_.path());
    if (uri_.empty()) GTEST_SKIP() << "there is no such camera on this machine";
    auto rig = OpenRig({.name = "contract", .camera_uri = uri_}, SystemClock());
    ASSERT_TRUE(rig.ok()) << rig.status();
    rig_ = *std::move(rig);
  }

  Camera& camera() { return *rig_.camera; }

  void Begin(const CaptureSpec& spec) {
    ASSERT_TRUE(camera().Stop().ok());
    ASSERT_TRUE(rig_.presenter->Present(spec).ok());
    ASSERT_TRUE(camera().Configure({spec.exposure_s, spec.gain_db}).ok());
    ASSERT_TRUE(camera().Start().ok());
  }

  Frame Take() {
    EXPECT_TRUE(camera().Trigger().ok());
    auto frame = camera().NextFrame(GetParam().timeout);
    EXPECT_TRUE(frame.ok()) << frame.status();
    return frame.ok() ? *std::move(frame) : Frame();
  }

  const TemporaryFolder folder_;
  std::string uri_;
  Rig rig_;
};

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_CONTRACT_CAMERA_CONTRACT_H_
