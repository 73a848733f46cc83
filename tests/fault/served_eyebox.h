// `eyebox serve` as a process of its own, on a socket in a folder of its own.
#ifndef EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_
#define EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_

#include <grpcpp/grpcpp.h>
#include <signal.h>
#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "eyebox/v1/service.grpc.pb.h"

namespace eyebox::service {

class ServedEyebox {
 public:
  // Data in `folder`/data, state in `folder`/state. `launcher` (strace, say) stands before the
  // program and must leave it the process id that it was started with. `options` of serve come
  // after those. Ready when it returns.
  ServedEyebox(const std::filesystem::path& folder, const std::vector<std::string>& launcher,
               const std::vector<std::string>& options = {});
  ~ServedEyebox() { Stop(); }

  v1::RunService::Stub& stub() { return *stub_; }
  // Another connection: gRPC would share one between channels that look the same.
  std::shared_ptr<grpc::Channel> Connect() const;
  std::filesystem::path Socket() const;
  pid_t process() const { return process_; }
  bool Alive() const;
  // SIGTERM; the exit status, 128 and more for a signal.
  int Stop() { return End(SIGTERM); }
  // SIGKILL; as Stop.
  int Kill() { return End(SIGKILL); }

 private:
  int End(int signal);

  std::string address_;
  pid_t process_ = -1;
  std::unique_ptr<v1::RunService::Stub> stub_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_
