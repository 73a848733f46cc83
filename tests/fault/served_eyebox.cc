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
                           const std::vector<std::string>& launcher,
                           const std::vector<std::string>& options)
    : address_("unix:" + (folder / "s").string()) {
  std::vector<std::string> arguments = launcher;
  for (const std::string& argument :
       {std::string(EYEBOX_BINARY_DIR "/bin/eyebox"), std::string("serve"), std::string("--listen"),
        address_, std::string("--data"), (folder / "data").string(), std::string("--state"),
        (folder / "state").string()}) {
    arguments.push_back(argument);
  }
  arguments.insert(arguments.end(), options.begin(), options.end());
  // A channel that nobody uses looks so often whether its server says good-bye; the server waits.
  setenv("GRPC_CLIENT_CHANNEL_BACKUP_POLL_INTERVAL_MS", "50", 0);
  process_ = StartProcess(arguments, (folder / "log").string());
  const auto channel = Connect();
  EXPECT_TRUE(
      channel->WaitForConnected(std::chrono::system_clock::now() + std::chrono::seconds(60)));
  stub_ = v1::RunService::NewStub(channel);
}

std::shared_ptr<grpc::Channel> ServedEyebox::Connect() const {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  // What nobody reads shall wait with the server, not in a window that grows.
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  // A server that is being started anew is soon back.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 100);
  return grpc::CreateCustomChannel(address_, grpc::InsecureChannelCredentials(), arguments);
}

std::filesystem::path ServedEyebox::Socket() const {
  return address_.substr(std::string("unix:").size());
}

bool ServedEyebox::Alive() const {
  return process_ > 0 && waitpid(process_, nullptr, WNOHANG) == 0;
}

int ServedEyebox::End(int signal) {
  if (process_ <= 0) return 0;
  kill(process_, signal);
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace eyebox::service
