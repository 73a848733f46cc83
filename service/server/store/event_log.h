// The life of a job on disk: one JSON object a line, appended and never changed.
#ifndef EYEBOX_SERVICE_SERVER_STORE_EVENT_LOG_H_
#define EYEBOX_SERVICE_SERVER_STORE_EVENT_LOG_H_

#include <filesystem>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "eyebox/v1/service.pb.h"

namespace eyebox::service {

// On stable storage when it returns OK. A line that could not be written whole is taken back.
// Errors: the errno of the disk.
absl::Status AppendEvent(const std::filesystem::path& log, const v1::JobEvent& event);

// All events, 1, 2, ... A last line without its newline was never acknowledged: it is cut off.
// Errors: NotFound, DataLoss naming the line.
absl::StatusOr<std::vector<v1::JobEvent>> RecoverEvents(const std::filesystem::path& log);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_SERVER_STORE_EVENT_LOG_H_
