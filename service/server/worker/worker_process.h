// Work in a process of its own, with limits: a recording that somebody else made may crash or
// exhaust what parses it, and then takes a worker down, never the server.
#ifndef EYEBOX_SERVICE_SERVER_WORKER_WORKER_PROCESS_H_
#define EYEBOX_SERVICE_SERVER_WORKER_WORKER_PROCESS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "service/server/jobs/jobs.h"

namespace eyebox::service {

struct WorkerLimits {
  uint64_t address_space_bytes = 0;         // 0: three quarters of the machine's memory
  uint64_t cpu_s = 12 * 3600;               // over all threads
  uint64_t file_bytes = uint64_t{1} << 40;  // of one file that it writes
  uint64_t open_files = 512;
};

// Each assignment is done by `command` (a program and its arguments), which calls ServeAssignment.
// Status of the work: what the worker says; DataLoss if a signal ended it; ResourceExhausted if it
// used up its processor time; Internal if it ended without a word. The worker dies with the thread
// that started it, so also when the server is killed.
Work MakeProcessWork(std::vector<std::string> command, const WorkerLimits& limits);

// The worker's side: takes one assignment, closes what `work` does not need, does it. The exit
// status of the process: 0 if the server was told how it ended.
int ServeAssignment(const Work& work);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_WORKER_WORKER_PROCESS_H_
