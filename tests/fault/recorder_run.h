// Runs fault_recorder under strace and tells what became of it.
#ifndef EYEBOX_TESTS_FAULT_RECORDER_RUN_H_
#define EYEBOX_TESTS_FAULT_RECORDER_RUN_H_

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace eyebox::capture {

struct RecorderRun {
  std::filesystem::path recording;
  int exit_code = 0;                // as the shell has it: 137 when killed
  std::map<int, int> acknowledged;  // frames by capture
  std::string errors;               // stderr
  std::string trace;                // of strace
};

// Output and standard error of a shell command, and its exit status.
struct ShellOutput {
  int exit_code = 0;
  std::string text;
};
ShellOutput RunShell(const std::string& command);

// Empty where strace may trace and h5py is there; otherwise what is missing.
std::string WhatIsMissing();

constexpr int kCaptures = 2;
constexpr int kFramesPerCapture = 4;

// `launcher` stands before the program: "strace ...", "timeout ...", "LD_PRELOAD=... ".
RecorderRun RunRecorder(const std::filesystem::path& recording, const std::string& launcher,
                        int captures = kCaptures, int frames = kFramesPerCapture, int side_px = 9);

// strace with `inject`, for example "pwrite64:error=EIO:when=3".
RecorderRun RunWithFault(const std::filesystem::path& recording, const std::string& inject);

// The calls of a run that nothing disturbs: how often it calls `name` before it begins, and in all.
struct CallCount {
  int before = 0;
  int total = 0;
};
CallCount CountCalls(const std::filesystem::path& folder, const std::string& name);

// Reads every acknowledged frame of every run with h5py alone. Empty where all are bit-exact.
std::string CompareWithH5py(const std::vector<RecorderRun>& runs);

// Recovers, and expects of the result: it verifies, holds every acknowledged frame, and no frame
// that was not recorded or stands there twice.
void ExpectRecovers(const RecorderRun& run);

}  // namespace eyebox::capture

#endif  // EYEBOX_TESTS_FAULT_RECORDER_RUN_H_
