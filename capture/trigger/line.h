// The seam to a GPIO line. libgpiod_line.cc is the only use of gpiod.h; sim_line.cc leads from an
// output to the inputs of its name; tests put lines of their own in their place.
#ifndef EYEBOX_CAPTURE_TRIGGER_LINE_H_
#define EYEBOX_CAPTURE_TRIGGER_LINE_H_

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "capture/base/clock.h"
#include "capture/trigger/trigger.h"

namespace eyebox::capture {

// Off when opened and when destroyed. Errors: Unavailable.
class OutputLine {
 public:
  virtual ~OutputLine() = default;
  virtual absl::Status Set(bool on) = 0;
};

class InputLine {
 public:
  virtual ~InputLine() = default;
  // What is queued, at most 16; empty after `timeout`. Errors: Unavailable.
  virtual absl::StatusOr<std::vector<Edge>> Read(std::chrono::milliseconds timeout) = 0;
};

inline constexpr size_t kKernelQueue = 16;

struct LineAddress {
  std::string chip;  // "gpiochip0", or empty for a simulated line
  std::string line;  // number or name
};

// "gpiochipN:LINE" or "sim:NAME". Errors: InvalidArgument.
absl::StatusOr<LineAddress> ParseLineUri(const std::string& uri);

absl::StatusOr<std::unique_ptr<OutputLine>> OpenGpioOutput(const LineAddress& address,
                                                           bool active_low);
absl::StatusOr<std::unique_ptr<InputLine>> OpenGpioInput(const LineAddress& address, EdgeKind kind,
                                                         bool active_low);

// Edges are stamped by `clock` when the output is set, and queue without limit.
std::unique_ptr<OutputLine> OpenSimOutput(const std::string& name, const Clock* clock);
std::unique_ptr<InputLine> OpenSimInput(const std::string& name, EdgeKind kind);

}  // namespace eyebox::capture

#endif  // EYEBOX_CAPTURE_TRIGGER_LINE_H_
