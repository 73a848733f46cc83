// What the kernel and the server's own figures say of a server under trial.
#ifndef EYEBOX_TESTS_FAULT_SERVER_PROCESS_H_
#define EYEBOX_TESTS_FAULT_SERVER_PROCESS_H_

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>

#include "tests/fault/served_eyebox.h"

namespace eyebox::service {

// VmRSS and VmHWM, now and the most so far, of a process in KiB.
struct Memory {
  int64_t now_kib = 0;
  int64_t most_kib = 0;
};
Memory MemoryOf(pid_t process);

int OpenFilesOf(pid_t process);

// A port of the loopback that nobody uses.
int FreePort();

// The value of a figure without labels that is served on that port; -1 if it is not there.
double Figure(int port, const std::string& name);

// Reads until the value is at most `limit`, for a minute at most; gives the last one.
double AwaitAtMost(double limit, const std::function<double()>& read);

// Over a connection of its own.
bool IsServing(const ServedEyebox& server);

}  // namespace eyebox::service

#endif  // EYEBOX_TESTS_FAULT_SERVER_PROCESS_H_
