#include "tests/fault/served_eyebox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

namespace eyebox::service {
namespace {

pid_t StartProcess(std::vector<std::string> arguments, const std::string& log) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const pid_t process = fork();
  if (process != 0) return process;
  const int file = open(log.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
  dup2(file, 1);
  dup2(file, 2);
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // a leak checker cannot work beside strace
  execvp(pointers[0], pointers.data());
  _exit(127);
}

}  // namespace

ServedEyebox::ServedEyebox(const std::filesystem::path& folder,
                           const std::vector<std::string>& launcher) {
  const std::string address = "unix:" + (folder / "s").string();
  std::vector<std::string> arguments = launcher;
  for (const std::string& argument :
       {std::string(EYEBOX_BINARY_DIR "/bin/eyebox"), std::string("serve"), std::string("--listen"),
        address, std::string("--data"), (folder / "data").string(), std::string("--state"),
        (folder / "state").string()}) {
    arguments.push_back(argument);
  }
  process_ = StartProcess(arguments, (folder / "log").string());
  const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  EXPECT_TRUE(
      channel->WaitForConnected(std::chrono::system_clock::now() + std::chrono::seconds(60)));
  stub_ = v1::RunService::NewStub(channel);
}

bool ServedEyebox::Alive() const {
  return process_ > 0 && waitpid(process_, nullptr, WNOHANG) == 0;
}

int ServedEyebox::Stop() {
  if (process_ <= 0) return 0;
  kill(process_, SIGTERM);
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace eyebox::service
