// `eyebox serve` as a process of its own, on a socket in a folder of its own.
#ifndef EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_
#define EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_

#include <grpcpp/grpcpp.h>
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
  // program and must leave it the process id that it was started with. Ready when it returns.
  ServedEyebox(const std::filesystem::path& folder, const std::vector<std::string>& launcher);
  ~ServedEyebox() { Stop(); }

  v1::RunService::Stub& stub() { return *stub_; }
  bool Alive() const;
  // SIGTERM; the exit status, 128 and more for a signal.
  int Stop();

 private:
  pid_t process_ = -1;
  std::unique_ptr<v1::RunService::Stub> stub_;
};

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_FAULT_SERVED_EYEBOX_H_
