#include "tests/fault/recorder_run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include "capture/base/file.h"
#include "capture/recording/recover.h"
#include "tests/fault/fault_frame.h"

namespace eyebox::capture {
namespace {

constexpr const char* kPython = "/usr/bin/python3";  // Debian's, which python3-h5py belongs to

std::map<int, int> ParseAcknowledgements(const std::string& text) {
  std::map<int, int> acknowledged;
  std::istringstream lines(text);
  std::string word;
  while (lines >> word) {
    int capture = 0;
    int frames = 0;
    if (word == "ack" && lines >> capture >> frames) acknowledged[capture] = frames;
  }
  return acknowledged;
}

std::string Content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The ids of all frames that the reader shows, each compared pixel by pixel.
std::multiset<uint64_t> ShownIds(const std::filesystem::path& recording) {
  std::multiset<uint64_t> ids;
  const auto reader = RecordingReader::Open(recording);
  EXPECT_TRUE(reader.ok()) << reader.status();
  if (!reader.ok()) return ids;
  for (const CaptureEntry& capture : (*reader)->Captures()) {
    const absl::Status status = (*reader)->VisitFrames(capture, [&ids](const Frame& frame) {
      const uint64_t id = frame.metadata.camera_frame_id;
      EXPECT_TRUE(
          std::ranges::equal(frame.view.pixels_dn, FaultFrame(id, frame.view.size).view.pixels_dn))
          << "frame " << id << " was invented";
      ids.insert(id);
      return absl::OkStatus();
    });
    EXPECT_TRUE(status.ok()) << status;
  }
  return ids;
}

// Every acknowledged sample is there, and none that was not recorded.
void ExpectSamples(const RecorderRun& run) {
  const auto reader = RecordingReader::Open(run.recording);
  ASSERT_TRUE(reader.ok()) << reader.status();
  for (const CaptureEntry& capture : (*reader)->Captures()) {
    size_t samples = 0;
    const auto compare = [&samples](const SampleBlock& block) {
      EXPECT_EQ(block, FaultSamples(static_cast<int>(samples / kSamplesPerFrame)));
      samples += block.samples.size();
      return absl::OkStatus();
    };
    const absl::Status status = (*reader)->VisitSamples(capture, compare);
    EXPECT_TRUE(status.ok()) << status;
    const auto acknowledged = run.acknowledged.find(capture.number);
    if (acknowledged == run.acknowledged.end()) continue;
    EXPECT_GE(samples, kSamplesPerFrame * static_cast<size_t>(acknowledged->second));
    EXPECT_FALSE((*reader)->ClockTriples(capture)->empty());
  }
}

}  // namespace

ShellOutput RunShell(const std::string& command) {
  ShellOutput output;
  FILE* pipe = ::popen(("{ " + command + "\n} 2>&1").c_str(), "r");
  std::array<char, 4096> piece;
  while (pipe && std::fgets(piece.data(), piece.size(), pipe)) output.text += piece.data();
  const int status = pipe ? ::pclose(pipe) : -1;
  output.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return output;
}

std::string WhatIsMissing() {
  if (RunShell("strace -o /dev/null true").exit_code != 0) {
    return "strace is not installed or may not trace here; scripts/bootstrap.sh check installs it";
  }
  if (RunShell(std::string(kPython) + " -c 'import h5py'").exit_code != 0) {
    return "python3-h5py is not installed; scripts/bootstrap.sh check installs it";
  }
  return "";
}

RecorderRun RunRecorder(const std::filesystem::path& recording, const std::string& launcher,
                        int captures, int frames, int side_px) {
  const std::string base = recording.string();
  // A leak checker cannot work beside strace.
  RunShell("ASAN_OPTIONS=detect_leaks=0 " + launcher + " " EYEBOX_FAULT_RECORDER " " + base + " " +
           std::to_string(captures) + " " + std::to_string(frames) + " " + std::to_string(side_px) +
           " >" + base + ".out 2>" + base + ".err; echo $? >" + base + ".code");
  RecorderRun run;
  run.recording = recording;
  std::istringstream(Content(base + ".code")) >> run.exit_code;
  run.acknowledged = ParseAcknowledgements(Content(base + ".out"));
  run.errors = Content(base + ".err");
  run.trace = Content(base + ".trace");
  return run;
}

RecorderRun RunWithFault(const std::filesystem::path& recording, const std::string& inject) {
  const std::string call =
      inject.substr(0, inject.find(':'));  // untraced, it would not be injected
  return RunRecorder(recording, "strace -y -o " + recording.string() +
                                    ".trace -e trace=fsync,fdatasync," + call +
                                    " -e inject=" + inject);
}

CallCount CountCalls(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path recording = folder / ("count-" + name);
  const RecorderRun run =
      RunRecorder(recording, "strace -o " + recording.string() + ".trace -e trace=write," + name);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  CallCount count;
  bool begun = false;
  std::istringstream lines(run.trace);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(name + "(")) {
      ++count.total;
      if (!begun) ++count.before;
    }
    begun |= line.find("\"begin\\n\"") != std::string::npos;
  }
  EXPECT_TRUE(begun) << run.trace;
  return count;
}

std::string CompareWithH5py(const std::vector<RecorderRun>& runs) {
  if (runs.empty()) return "there is nothing to compare";
  const std::string list = runs.front().recording.string() + ".list";
  {
    std::ofstream lines(list);
    for (const RecorderRun& run : runs) {
      for (const auto& [capture, frames] : run.acknowledged) {
        lines << run.recording.string() << " " << capture << " " << frames << "\n";
      }
    }
  }
  return RunShell(std::string(kPython) + " " EYEBOX_SOURCE_DIR "/tests/fault/check_frames.py <" +
                  list)
      .text;
}

void ExpectRecovers(const RecorderRun& run) {
  SCOPED_TRACE(run.recording.string());
  const auto report = RecoverRecording(run.recording);
  if (absl::IsNotFound(report.status())) {
    EXPECT_TRUE(run.acknowledged.empty()) << report.status();
    return;
  }
  ASSERT_TRUE(report.ok()) << report.status();
  const std::multiset<uint64_t> ids = ShownIds(run.recording);
  for (const uint64_t id : ids) EXPECT_EQ(ids.count(id), 1U) << "frame " << id;
  for (const auto& [capture, frames] : run.acknowledged) {
    for (int row = 0; row < frames; ++row) {
      const auto id = kIdsPerCapture * static_cast<uint64_t>(capture) + static_cast<uint64_t>(row);
      EXPECT_TRUE(ids.contains(id)) << "frame " << id << " was acknowledged and is lost";
    }
  }
  ExpectSamples(run);
  const auto again = RecoverRecording(run.recording);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->verified.frames, static_cast<int64_t>(ids.size()));
  EXPECT_FALSE(again->capture.has_value()) << "one recovery is enough";
}

}  // namespace eyebox::capture
