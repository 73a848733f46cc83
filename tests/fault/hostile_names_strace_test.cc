// Under strace: whatever names clients send, no file outside of the store is opened.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "capture/base/file.h"
#include "tests/fault/recorder_run.h"
#include "tests/fault/served_eyebox.h"
#include "tests/service/server/hostile_names.h"
#include "tests/support/temporary_folder.h"

namespace eyebox::service {
namespace {

using testing::HasSubstr;

// Lines of the trace that open something, from `begin` on.
std::vector<std::string> Opens(const std::string& trace, size_t begin) {
  std::vector<std::string> opens;
  std::istringstream lines(trace.substr(begin));
  for (std::string line; std::getline(lines, line);) {
    if (line.find("open") != std::string::npos || line.find("creat(") != std::string::npos) {
      opens.push_back(line);
    }
  }
  return opens;
}

// Of "openat(...) = 7</tmp/x/data>": /tmp/x/data; empty if it failed.
std::string OpenedPath(const std::string& line) {
  const size_t result = line.rfind(" = ");
  const size_t begin = result == std::string::npos ? result : line.find('<', result);
  if (begin == std::string::npos) return "";
  return line.substr(begin + 1, line.rfind('>') - begin - 1);
}

// strace writes a little later than the process ends.
std::string WholeTrace(const std::filesystem::path& file) {
  for (int i = 0; i < 600; ++i) {
    const std::string trace = *ReadWholeFile(file, size_t{256} << 20);
    if (trace.find("+++ exited with") != std::string::npos) return trace;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return "";
}

TEST(HostileNamesUnderStrace, NoFileOutsideTheStoreIsOpened) {
  if (capture::RunShell("strace -D -o /dev/null true").exit_code != 0) {
    GTEST_SKIP() << "strace is not installed or may not trace here; scripts/bootstrap.sh check";
  }
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "data/rec/captures");
  ASSERT_TRUE(WriteFileAtomically(folder / "secret", "secret").ok());
  const std::filesystem::path trace = folder / "trace";
  ServedEyebox server(folder.path(), {"strace", "-D", "-f", "-y", "-s", "300", "-o", trace, "-e",
                                      "trace=open,openat,openat2,creat"});
  // What it opens to come up (libraries, settings of the system) is not what clients lead it to.
  const size_t begin = std::filesystem::file_size(trace);
  int refused = 0;
  for (const NameField& field : NameFields()) {
    for (const std::string& name : HostileNames()) {
      const grpc::Status status = field.send(server.stub(), name);
      if (!status.ok()) ++refused;
    }
  }
  EXPECT_EQ(refused, static_cast<int>(NameFields().size() * HostileNames().size()));
  // One that passes the table shows that the trace would show it.
  for (const NameField& field : NameFields()) {
    if (field.field == "recording") field.send(server.stub(), "not-there");
  }
  ASSERT_TRUE(server.Alive());
  EXPECT_EQ(server.Stop(), 0);
  const std::string text = WholeTrace(trace);
  EXPECT_THAT(text.substr(std::min(begin, text.size())), HasSubstr("\"not-there\""));
  for (const std::string& line : Opens(text, std::min(begin, text.size()))) {
    EXPECT_EQ(line.find("secret"), std::string::npos) << line;
    EXPECT_EQ(line.find("passwd"), std::string::npos) << line;
    const std::string path = OpenedPath(line);
    const bool inside = path.empty() || path.starts_with((folder / "data").string()) ||
                        path.starts_with((folder / "state").string()) ||
                        path.starts_with("/proc/") || path.starts_with("/sys/") ||
                        path == "/dev/urandom" ||                  // of the libraries, once
                        path.starts_with("/usr/share/zoneinfo/");  // of the log's times
    EXPECT_TRUE(inside) << line;
  }
}

}  // namespace
}  // namespace eyebox::service
