// A serial port that is ours alone, raw, and never blocks for ever.
#ifndef EYEBOX_CAPTURE_PHOTODIODE_SERIAL_PORT_H_
#define EYEBOX_CAPTURE_PHOTODIODE_SERIAL_PORT_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace eyebox::capture::serial {

// Reading in one thread while another writes is allowed.
class Port {
 public:
  // 500000 baud, 8N1, no flow control, every translation off, and read back.
  // Errors: NotFound, PermissionDenied, ResourceExhausted (another program holds it; also within
  // one process), InvalidArgument (no terminal), Unavailable (settings not taken).
  static absl::StatusOr<std::unique_ptr<Port>> Open(const std::string& device);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  // What has arrived, 0 bytes after `timeout` without any. Errors: Unavailable (unplugged).
  absl::StatusOr<size_t> Read(std::span<uint8_t> bytes, std::chrono::milliseconds timeout);
  // All of them. Errors: Unavailable (unplugged, or nothing could be written for a second).
  absl::Status Write(std::span<const uint8_t> bytes);

 private:
  Port(std::string device, int fd) : device_(std::move(device)), fd_(fd) {}
  absl::Status Unplugged(int error_number) const;

  const std::string device_;
  const int fd_;
};

}  // namespace eyebox::capture::serial

#endif  // EYEBOX_CAPTURE_PHOTODIODE_SERIAL_PORT_H_
