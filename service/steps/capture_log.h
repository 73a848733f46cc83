// results/capture/captures.csv in a recording: how each capture went, for whoever wants to know.
#ifndef EYEBOX_SERVICE_STEPS_CAPTURE_LOG_H_
#define EYEBOX_SERVICE_STEPS_CAPTURE_LOG_H_

#include <filesystem>

#include "absl/status/status.h"
#include "capture/run.h"

namespace eyebox::service {

std::filesystem::path CaptureLogPath(const std::filesystem::path& recording);

// Appends a line; the first one of a file is preceded by the names of the columns. Times are in
// seconds, readings mean counts of the whole frame. settle_s is empty where the scene was there
// before. Not made durable: what it tells can be spared. Errors: the errno of the disk.
absl::Status LogCapture(const std::filesystem::path& recording,
                        const capture::CaptureFigures& figures);

}  // namespace eyebox::service

#endif  // EYEBOX_SERVICE_STEPS_CAPTURE_LOG_H_
