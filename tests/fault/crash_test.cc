// Killed at any moment, a recording keeps every frame that it acknowledged.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/fault/recorder_run.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::capture {
namespace {

class Crash : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (const std::string missing = WhatIsMissing(); !missing.empty()) GTEST_SKIP() << missing;
  }
  const TemporaryFolder folder_;
};

// Every call by which a recording reaches the disk; each is swept by itself.
INSTANTIATE_TEST_SUITE_P(Calls, Crash,
                         testing::Values("openat", "mkdir", "pwrite64", "fallocate", "flock",
                                         "fsync", "fdatasync", "rename", "write"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Crash, AtAnyCallKeepsEveryAcknowledgedFrame) {
  const std::string call = GetParam();
  const CallCount count = CountCalls(folder_.path(), call);
  ASSERT_GT(count.total, count.before) << "a recording calls it";
  std::vector<RecorderRun> runs;
  for (int n = count.before + 1; n <= count.total; ++n) {
    runs.push_back(RunWithFault(folder_ / (call + std::to_string(n)),
                                call + ":signal=KILL:when=" + std::to_string(n)));
    EXPECT_EQ(runs.back().exit_code, 137) << "call " << n << ": " << runs.back().errors;
  }
  EXPECT_EQ(CompareWithH5py(runs), "");
  for (const RecorderRun& run : runs) ExpectRecovers(run);
}

// Takes minutes: set EYEBOX_LONG_TESTS=1. Kills between any two instructions, not at calls alone.
TEST(CrashAtRandom, KeepsEveryAcknowledgedFrame) {
  if (const char* asked = std::getenv("EYEBOX_LONG_TESTS"); !asked || std::string(asked) != "1") {
    GTEST_SKIP() << "set EYEBOX_LONG_TESTS=1 to run it";
  }
  if (const std::string missing = WhatIsMissing(); !missing.empty()) GTEST_SKIP() << missing;
  constexpr int kKills = 500;
  constexpr int kBatch = 20;
  constexpr int kEndless = 900;  // captures: none gets that far
  std::mt19937 random(1);
  std::uniform_real_distribution<double> delay_s(0.02, 0.6);
  int killed = 0;
  int acknowledged = 0;
  for (int done = 0; done < kKills; done += kBatch) {
    const TemporaryFolder folder;
    std::vector<RecorderRun> runs;
    for (int i = 0; i < kBatch; ++i) {
      runs.push_back(RunRecorder(folder / std::to_string(i),
                                 "timeout -s KILL " + std::to_string(delay_s(random)), kEndless, 10,
                                 200));
      killed += runs.back().exit_code == 137 ? 1 : 0;
      for (const auto& [capture, frames] : runs.back().acknowledged) acknowledged += frames;
    }
    ASSERT_EQ(CompareWithH5py(runs), "");
    for (const RecorderRun& run : runs) ExpectRecovers(run);
  }
  EXPECT_EQ(killed, kKills);
  EXPECT_GT(acknowledged, 0);
  RecordProperty("killed", killed);
  RecordProperty("acknowledged_frames", acknowledged);
}

}  // namespace
}  // namespace eyebox::capture
