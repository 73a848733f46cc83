#include "tests/capture/camera/aravis_fake_process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if.h>
#include <sched.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

namespace eyebox::capture {
namespace {

constexpr uint16_t kControlPort = 3956;
constexpr const char* kProgram = "arv-fake-gv-camera-0.8";

bool RaiseLoopback() {
  const int any_socket = socket(AF_INET, SOCK_DGRAM, 0);
  ifreq request = {};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  const bool raised = ioctl(any_socket, SIOCSIFFLAGS, &request) == 0;
  close(any_socket);
  return raised;
}

bool LockLoopback() {
  const auto file = std::filesystem::temp_directory_path() / "eyebox-gige-loopback.lock";
  const int lock = open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  return lock >= 0 && flock(lock, LOCK_EX) == 0;  // until the process ends
}

// Sends a discovery command (GigE Vision 2.0, 16.1) and waits for any answer.
bool Answers() {
  const int probe = socket(AF_INET, SOCK_DGRAM, 0);
  const timeval patience = {.tv_sec = 0, .tv_usec = 20000};
  setsockopt(probe, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in camera = {};
  camera.sin_family = AF_INET;
  camera.sin_port = htons(kControlPort);
  camera.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  constexpr std::array<uint8_t, 8> kDiscovery = {0x42, 0x01, 0x00, 0x02, 0x00, 0x00, 0x12, 0x34};
  sendto(probe, kDiscovery.data(), kDiscovery.size(), 0, reinterpret_cast<sockaddr*>(&camera),
         sizeof camera);
  std::array<uint8_t, 1024> answer;
  const bool answered = recv(probe, answer.data(), answer.size(), 0) > 0;
  close(probe);
  return answered;
}

pid_t Spawn(const std::vector<std::string>& arguments) {
  std::vector<char*> raw;
  for (const std::string& argument : arguments) raw.push_back(const_cast<char*>(argument.c_str()));
  raw.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child != 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // never outlives the test
  if (getppid() == parent) execvp(raw[0], raw.data());
  _exit(127);
}

}  // namespace

bool EnterPrivateNetwork(std::string& why_not) {
  static const bool entered =
      (unshare(CLONE_NEWNET) == 0 || unshare(CLONE_NEWUSER | CLONE_NEWNET) == 0) ? RaiseLoopback()
                                                                                 : LockLoopback();
  if (!entered) why_not = std::string("no network for a fake camera: ") + std::strerror(errno);
  return entered;
}

std::unique_ptr<FakeGigECamera> FakeGigECamera::Start(const std::string& serial,
                                                      int lost_packets_per_thousand) {
  const pid_t process = Spawn(
      {kProgram, "-i", "127.0.0.1", "-s", serial, "-r", std::to_string(lost_packets_per_thousand)});
  if (process < 0) return nullptr;
  std::unique_ptr<FakeGigECamera> camera(
      new FakeGigECamera(process, "aravis:Aravis-Fake-" + serial));
  for (int i = 0; i < 200; ++i) {
    if (Answers()) return camera;
    if (waitpid(process, nullptr, WNOHANG) == process) {
      camera->process_ = 0;
      return nullptr;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return nullptr;
}

void FakeGigECamera::Kill() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
  process_ = 0;
}

}  // namespace eyebox::capture
