// A disk that is full, fails or lies: a clear error, and no acknowledged frame is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "capture/recording/reader.h"
#include "tests/fault/fault_frame.h"
#include "tests/fault/recorder_run.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

using testing::HasSubstr;

struct DiskFault {
  const char* call;
  const char* error;
};

class DiskFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = WhatIsMissing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  // One run for each call after the recording began.
  std::vector<RecorderRun> Sweep(const std::string& call, const std::string& fault) {
    const std::filesystem::path folder = folder_ / fault;
    std::filesystem::create_directories(folder);
    const CallCount count = CountCalls(folder, call);
    EXPECT_GT(count.total, count.before) << "a recording calls it";
    std::vector<RecorderRun> runs;
    for (int n = count.before + 1; n <= count.total; ++n) {
      runs.push_back(RunWithFault(folder / (call + std::to_string(n)),
                                  call + ":" + fault + ":when=" + std::to_string(n)));
    }
    return runs;
  }

  const TemporaryFolder folder_;
};

class DiskError : public DiskFaults, public testing::WithParamInterface<DiskFault> {};

INSTANTIATE_TEST_SUITE_P(
    Calls, DiskError,
    testing::Values(DiskFault{"pwrite64", "ENOSPC"}, DiskFault{"pwrite64", "EIO"},
                    DiskFault{"fallocate", "ENOSPC"}, DiskFault{"mkdir", "ENOSPC"},
                    DiskFault{"fsync", "EIO"}, DiskFault{"fdatasync", "EIO"},
                    DiskFault{"fdatasync", "ENOSPC"}, DiskFault{"rename", "EIO"}),
    [](const auto& test) { return std::string(test.param.call) + "_" + test.param.error; });

// The last file in `trace` whose fsync or fdatasync was made to fail, and whether it was asked for
// another one afterwards.
bool RetriesAFailedSync(const std::string& trace) {
  std::string failed;
  std::istringstream lines(trace);
  for (std::string line; std::getline(lines, line);) {
    const size_t begin = line.find('<');
    const size_t end = line.find('>');
    if (begin == std::string::npos || end == std::string::npos) continue;
    const std::string file = line.substr(begin, end - begin);
    const bool sync = line.starts_with("fsync") || line.starts_with("fdatasync");
    if (sync && file == failed) return true;
    if (sync && line.ends_with("(INJECTED)")) failed = file;
  }
  return false;
}

TEST_P(DiskError, IsNamedAndCostsNoAcknowledgedFrame) {
  const auto [call, error] = GetParam();
  const std::vector<RecorderRun> runs = Sweep(call, std::string("error=") + error);
  EXPECT_EQ(CompareWithH5py(runs), "");
  for (const RecorderRun& run : runs) {
    EXPECT_EQ(run.exit_code, 3) << run.recording << ": " << run.errors;
    EXPECT_THAT(run.errors, HasSubstr(folder_.path().string())) << "names the file";
    EXPECT_FALSE(RetriesAFailedSync(run.trace)) << run.trace;
    ExpectRecovers(run);
  }
}

TEST_F(DiskFaults, AFullDiskIsFoundBeforeTheFirstFrame) {
  for (const RecorderRun& run : Sweep("fallocate", "error=ENOSPC")) {
    const int captures = static_cast<int>(run.acknowledged.size());
    for (const auto& [capture, frames] : run.acknowledged) EXPECT_EQ(frames, kFramesPerCapture);
    EXPECT_THAT(run.errors, HasSubstr("the next capture needs"));
    EXPECT_FALSE(std::filesystem::exists(run.recording / "captures" /
                                         ("00000" + std::to_string(captures + 1) + ".h5.partial")));
    EXPECT_TRUE(VerifyRecording(run.recording).ok()) << "needs no recovery";
  }
}

TEST_F(DiskFaults, AWriteThatMakesNoProgressEndsTheRecording) {
  const std::vector<RecorderRun> runs = Sweep("pwrite64", "retval=0");
  EXPECT_EQ(CompareWithH5py(runs), "");
  for (const RecorderRun& run : runs) {
    // libhdf5 tries again and gets through; what is ours gives up.
    if (run.exit_code != 0) {
      EXPECT_THAT(run.errors, HasSubstr(run.recording.string()));
    }
    ExpectRecovers(run);
  }
}

TEST_F(DiskFaults, ShortAndInterruptedWritesAreCarriedOnWith) {
  for (const int bytes : {1, 7, 100}) {
    const RecorderRun run = RunRecorder(
        folder_ / ("short" + std::to_string(bytes)),
        "LD_PRELOAD=" EYEBOX_SHORT_WRITES " EYEBOX_SHORT_WRITE_BYTES=" + std::to_string(bytes));
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.acknowledged.size(), static_cast<size_t>(kCaptures));
    EXPECT_EQ(CompareWithH5py({run}), "");
    const auto verified = VerifyRecording(run.recording);
    ASSERT_TRUE(verified.ok()) << verified.status();
    EXPECT_EQ(verified->frames, kCaptures * kFramesPerCapture);
  }
}

// It says that it took the bytes and took none: nothing can save them, but nothing false is shown.
TEST_F(DiskFaults, BytesThatTheDiskSwallowedAreNeverShown) {
  for (const char* retval : {"1", "162"}) {  // a frame has 162 bytes
    for (const RecorderRun& run : Sweep("pwrite64", std::string("retval=") + retval)) {
      const auto reader = RecordingReader::Open(run.recording);
      if (!reader.ok()) continue;
      for (const CaptureEntry& capture : (*reader)->Captures()) {
        (*reader)
            ->VisitFrames(
                capture,
                [](const Frame& frame) {
                  const Frame expected =
                      FaultFrame(frame.metadata.camera_frame_id, frame.view.size);
                  EXPECT_TRUE(std::ranges::equal(frame.view.pixels_dn, expected.view.pixels_dn));
                  return absl::OkStatus();
                })
            .IgnoreError();
      }
    }
  }
}

}  // namespace
}  // namespace eyebox::capture
