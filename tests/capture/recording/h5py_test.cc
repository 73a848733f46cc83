// A capture file opens in plain h5py, which knows nothing of us.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

#include "capture/recording/pack.h"
#include "tests/capture/recording/recorded.h"

namespace eyebox::capture {
namespace {

std::string RunShell(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> piece;
  while (pipe && std::fgets(piece.data(), piece.size(), pipe)) output += piece.data();
  if (pipe) ::pclose(pipe);
  return output;
}

// Debian's own interpreter: python3-h5py belongs to it, whatever else comes first in PATH.
constexpr const char* kPython = "/usr/bin/python3";

// Prints shape and type, two pixels, and fields of the last record.
std::string Inspect(const std::filesystem::path& file) {
  return RunShell(std::string(kPython) + R"( -c '
import h5py, sys
with h5py.File(sys.argv[1], "r") as f:
    frames, records = f["frames"], f["frame_records"]
    print(frames.shape, frames.dtype.str, frames[0, 0, 1], frames[2, 4, 6])
    last = records[-1]
    print(len(records), last["camera_frame_id"], last["level_id"], last["state"], last["valid"])
    print(last["exposure_asked_s"], last["gain_reported_db"])
    print(f["meta/format"][()].decode())
    print("kind: FRAME_KIND_LIGHT" in f["meta/capture"][()].decode())
' )" + file.string());
}

constexpr const char* kExpected =
    "(3, 5, 7) <u2 2037 5258\n"
    "3 104 3 1 0\n"
    "0.0125 nan\n"
    "eyebox capture 1\n"
    "True\n";

class PlainH5py : public testing::Test {
 protected:
  void SetUp() override {
    if (!RunShell(std::string(kPython) + " -c 'import h5py'").empty()) {
      GTEST_SKIP() << "python3-h5py is not installed; run scripts/bootstrap.sh check";
    }
    Record(folder_ / "plain");
  }
  const TemporaryFolder folder_;
};

TEST_F(PlainH5py, OpensACapture) {
  EXPECT_EQ(Inspect(folder_ / "plain/captures/000002.h5"), kExpected);
}

TEST_F(PlainH5py, OpensAPackedCapture) {
  ASSERT_TRUE(PackRecording(folder_ / "plain", folder_ / "packed").ok());
  EXPECT_EQ(Inspect(folder_ / "packed/captures/000002.h5"), kExpected);
}

TEST_F(PlainH5py, OpensACaptureThatWasNeverPublished) {
  const std::filesystem::path recording = folder_ / "partial";
  auto writer = RecordingWriter::Create(recording, HeaderOf(), SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  {
    auto capture = (*writer)->BeginCapture(SpecOf(3), kFrameSize);
    ASSERT_TRUE(capture.ok()) << capture.status();
    for (int i = 2; i < 5; ++i) ASSERT_TRUE((*capture)->Append(FrameOf(i)).ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
  }
  EXPECT_EQ(Inspect(recording / "captures/000001.h5.partial"), kExpected);
}

TEST_F(PlainH5py, ReadsSamplesAndClockTriples) {
  const std::filesystem::path recording = folder_ / "samples";
  const auto writer = RecordingWriter::Create(recording, HeaderOf(), SystemClock());
  ASSERT_TRUE(writer.ok()) << writer.status();
  {
    const auto capture = (*writer)->BeginCapture(SpecOf(1), kFrameSize, {3, 2});
    ASSERT_TRUE(capture.ok()) << capture.status();
    ASSERT_TRUE(
        (*capture)
            ->AppendClockTriple({.monotonic_ns = 8, .real_ns = 9, .device_ns = 7, .window_ns = 2})
            .ok());
    ASSERT_TRUE((*capture)->Append(FrameOf(2)).ok());
    ASSERT_TRUE(
        (*capture)
            ->AppendSamples({.sequence = 4, .lost_before = 4, .samples = {{1000, -5}, {2000, 6}}})
            .ok());
    ASSERT_TRUE((*capture)->Acknowledge().ok());
    ASSERT_TRUE((*capture)->Publish().ok());
  }
  ASSERT_TRUE(PackRecording(recording, folder_ / "packed").ok());
  for (const auto& folder : {recording, folder_ / "packed"}) {
    EXPECT_EQ(RunShell(std::string(kPython) + R"( -c '
import h5py, sys
with h5py.File(sys.argv[1], "r") as f:
    samples, groups, triples = f["photodiode/samples"], f["photodiode/groups"], f["clock_triples"]
    count = int(groups["count"].sum())
    print(len(samples), count, samples["counts"][:count], samples["monotonic_ns"][:count],
          samples["sequence"][:count], samples["lost_before"][:count])
    print(len(triples), triples["monotonic_ns"][0], triples["device_ns"][0], triples["written"])
' )" + (folder / "captures/000001.h5").string()),
              "3 2 [-5  6] [1000 2000] [4 5] [4 0]\n2 8 7 [1 0]\n");
  }
}

}  // namespace
}  // namespace eyebox::capture
