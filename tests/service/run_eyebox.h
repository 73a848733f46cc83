// Runs the binary as a person would.
#ifndef EYEBOX_TESTS_SERVICE_RUN_EYEBOX_H_
#define EYEBOX_TESTS_SERVICE_RUN_EYEBOX_H_

#include <google/protobuf/message.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "capture/base/file.h"
#include "service/result_json.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {

struct Outcome {
  int exit_code = -1;
  std::string out;
  std::string err;
};

// `arguments` as for a shell.
inline Outcome RunEyebox(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string out = folder / "out";
  const std::string err = folder / "err";
  const std::string command =
      EYEBOX_BINARY_DIR "/bin/eyebox " + arguments + " >" + out + " 2>" + err;
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, *ReadWholeFile(out), *ReadWholeFile(err)};
}

// Fails the test unless stdout is that message and nothing else.
template <typename Message>
Message ParsedFrom(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  Message message;
  const absl::Status status = ParseJson(outcome.out, "stdout", message);
  EXPECT_TRUE(status.ok()) << status << "\n" << outcome.out;
  return message;
}

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_SERVICE_RUN_EYEBOX_H_
